#include "target.hpp"

namespace burin::rivals {

class CoverageTarget {
  public:
    CoverageTarget(const gl::Functions& gl, int width, int height) : gl_(gl), width_(width), height_(height) {
        gl_.GenFramebuffers(1, &framebuffer_);
        gl_.GenRenderbuffers(2, buffers_);
        bind();
        constexpr GLenum kFormats[] = {GL_RGBA32F, GL_DEPTH_COMPONENT32F}, kPlaces[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
        for (int i = 0; i < 2; ++i) {
            gl_.BindRenderbuffer(GL_RENDERBUFFER, buffers_[i]);
            gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, 4, kFormats[i], width, height);
            gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, kPlaces[i], GL_RENDERBUFFER, buffers_[i]);
        }
    }
    CoverageTarget(const CoverageTarget&) = delete;
    CoverageTarget& operator=(const CoverageTarget&) = delete;
    ~CoverageTarget() {
        gl_.DeleteRenderbuffers(2, buffers_);
        gl_.DeleteFramebuffers(1, &framebuffer_);
    }
    bool complete() const { return gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE; }
    void bind() const {
        gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        gl_.Viewport(0, 0, width_, height_);
    }
    void resolve_into(const gl::FloatTarget& target) const {
        target.bind();
        gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
        gl_.BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }

  private:
    const gl::Functions& gl_;
    int width_, height_;
    GLuint framebuffer_ = 0, buffers_[2] = {0, 0};
};

Result<std::unique_ptr<Target>> Target::create(const gl::Functions& gl, int width, int height, bool outlines) {
    auto plain = gl::FloatTarget::create(gl, width, height, 1, true);
    if (!plain) return plain.error();
    std::unique_ptr<Target> target(new Target);
    target->plain_ = std::move(*plain);
    if (!outlines) return target;
    target->coverage_ = std::make_unique<CoverageTarget>(gl, width, height);
    if (!target->coverage_->complete()) return Error{ErrorCode::unavailable, "the driver has no float target of four samples"};
    return target;
}

Target::~Target() = default;

void Target::bind() const { coverage_ ? coverage_->bind() : plain_->bind(); }

std::vector<float> Target::read() const {
    if (coverage_) coverage_->resolve_into(*plain_);
    return plain_->read(0);
}

}  // namespace burin::rivals
