#include "gl/program.hpp"

#include <algorithm>
#include <utility>

#include "cpp/drop_range.hpp"
#include "cpp/prefilter.hpp"
#include "gl/pixel_filter.h"
#include "gl/shader_text.hpp"

namespace burin::gl {
namespace {

constexpr const char* kVersion =
    "#version 330 core\n#define BURIN_OUT(type) out type\n#define BURIN_INOUT(type) inout type\n";

constexpr int kResidualUnit = 3;  // behind those of the pattern and the renderer's own
constexpr int kPrefilterUnit = 4;
constexpr int kChartUnit = 5;

// Log of a shader or program, shortened: from its first error on, since drivers write warnings before.
template <typename Query, typename Log>
std::string log_of(Query query, Log log, GLuint id) {
    GLint length = 0;
    query(id, GL_INFO_LOG_LENGTH, &length);
    std::string text(std::size_t(std::max(length, 1)), '\0');
    log(id, length, &length, text.data());
    text.resize(std::size_t(std::max(length, 0)));
    const std::size_t error = text.find("error");
    if (error != std::string::npos) text.erase(0, text.rfind('\n', error) + 1);
    text.resize(std::min<std::size_t>(text.size(), 400));
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

Result<GLuint> compile(const Functions& gl, GLenum kind, const std::string& text) {
    const GLuint id = gl.CreateShader(kind);
    const char* source = text.c_str();
    gl.ShaderSource(id, 1, &source, nullptr);
    gl.CompileShader(id);
    GLint ok = 0;
    gl.GetShaderiv(id, GL_COMPILE_STATUS, &ok);
    if (ok == GL_TRUE) return id;
    Error error{ErrorCode::unavailable,
                "the driver refuses a shader: " + log_of(gl.GetShaderiv, gl.GetShaderInfoLog, id)};
    gl.DeleteShader(id);
    return error;
}

GLuint make_texture(const Functions& gl, GLint format, GLenum layout, int width, int height,
                    const std::vector<std::uint32_t>& words, std::size_t per_texel) {
    // A texture of whole rows, whatever the vector holds.
    std::vector<std::uint32_t> padded(words);
    padded.resize(std::size_t(width) * std::size_t(height) * per_texel);
    GLuint name = 0;
    gl.GenTextures(1, &name);
    gl.BindTexture(GL_TEXTURE_2D, name);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl.TexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, layout, GL_UNSIGNED_INT, padded.data());
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return name;
}

// The bound texture, from now on with mipmaps and linear filters, wrapping as the pattern does.
void filter_smoothly(const Functions& gl, GLenum target, bool repeat) {
    gl.GenerateMipmap(target);
    gl.TexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    gl.TexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    for (const GLenum side : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        gl.TexParameteri(target, side, repeat ? GL_REPEAT : GL_CLAMP_TO_EDGE);
}

// A residual, filtered as its sampler says; one texel that is never asked where there is none.
GLuint make_residual(const Functions& gl, const RgbaImage& picture, bool repeat) {
    const std::vector<std::uint8_t> none(4, 128);
    const bool empty = picture.width == 0;
    GLuint name = 0;
    gl.GenTextures(1, &name);
    gl.BindTexture(GL_TEXTURE_2D, name);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, empty ? 1 : picture.width, empty ? 1 : picture.height, 0, GL_RGBA,
                  GL_UNSIGNED_BYTE, empty ? none.data() : picture.texels.data());
    filter_smoothly(gl, GL_TEXTURE_2D, repeat);
    return name;
}

// Weights of the prefilter's classes, four to a layer, with their averages over ever larger blocks.
GLuint make_prefilter(const Functions& gl, const Prefilter& filter, bool repeat) {
    const std::size_t layers = std::max<std::size_t>((filter.classes.size() + 3) / 4, 1);
    const int columns = std::max(filter.columns, 1), rows = std::max(filter.rows, 1);
    std::vector<float> texels(layers * 4 * std::size_t(columns) * std::size_t(rows), 0.0f);
    for (std::size_t k = 0; k < filter.classes.size(); ++k)
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x)
                texels[((k / 4 * std::size_t(rows) + std::size_t(y)) * std::size_t(columns) + std::size_t(x)) * 4 + k % 4] =
                    filter.weight(k, x, y);
    GLuint name = 0;
    gl.GenTextures(1, &name);
    gl.BindTexture(GL_TEXTURE_2D_ARRAY, name);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA16F, columns, rows, GLsizei(layers), 0, GL_RGBA, GL_FLOAT, texels.data());
    filter_smoothly(gl, GL_TEXTURE_2D_ARRAY, repeat);
    return name;
}

}  // namespace

std::string fragment_text(const ProgramKind& kind) {
    const Stage stage = kind.stage;
    std::string text = kVersion;
    if (stage == Stage::surface_with_depth) text += "#define BURIN_CORRECT_DEPTH\n";
    if (kind.counted) text += "#define BURIN_COUNTED\n";
    text += "#define PIXEL_FILTER " + std::to_string(kind.pixel_filter) + "\n";
    text += kinds_text(kind.pattern);
    text += kind.round ? "#define BURIN_ROUND 1\n" : "#define BURIN_ROUND 0\n";
    text += "#define BURIN_TEXTURES " + std::to_string(kind.textures) + "\n";
    text += kind.environment ? "#define BURIN_ENVIRONMENT\n" : "#define BURIN_NOOKS 0\n";
    text += kind.charts ? "#define BURIN_CHARTS 1\n" : "#define BURIN_CHARTS 0\n";
    text += shader_text::layout;
    text += shader_text::types;
    text += shader_text::bindings;
    for (const char* part :
         {shader_text::fetch, shader_text::perturbation, shader_text::curve, shader_text::domain, shader_text::section,
          shader_text::ground, shader_text::trace, shader_text::chord, shader_text::chart, shader_text::curvature, shader_text::facet, shader_text::surface, shader_text::residual, shader_text::residual_fetch})
        text += part;
    if (stage == Stage::rays) return text + shader_text::rays_frag;
    if (stage == Stage::top) return text + shader_text::top_frag;
    for (const char* part : {shader_text::pixel_filter, shader_text::curved, shader_text::frame, shader_text::lamp, shader_text::material,
                             kind.environment ? shader_text::environment : "", shader_text::shade})
        text += part;
    if (kind.pixel_filter != FILTER_RAYS)
        for (const char* part : {shader_text::footprint, shader_text::stripe, shader_text::region, shader_text::far, shader_text::far_fetch})
            text += part;
    return text + shader_text::surface_frag;
}

Result<Program> Program::build(const Functions& gl, const ProgramKind& kind) {
    const std::string vertex_text =
        std::string(kVersion) +
        (kind.stage == Stage::rays || kind.stage == Stage::top ? shader_text::screen_vert : shader_text::surface_vert);
    return build(gl, vertex_text, fragment_text(kind));
}

Result<Program> Program::build(const Functions& gl, const std::string& vertex_text, const std::string& fragment_text) {
    auto vertex = compile(gl, GL_VERTEX_SHADER, vertex_text);
    if (!vertex) return vertex.error();
    auto fragment = compile(gl, GL_FRAGMENT_SHADER, fragment_text);
    if (!fragment) {
        gl.DeleteShader(*vertex);
        return fragment.error();
    }
    Program program(gl, gl.CreateProgram());
    for (GLuint shader : {*vertex, *fragment}) {
        gl.AttachShader(program.id_, shader);
        gl.DeleteShader(shader);
    }
    gl.LinkProgram(program.id_);
    GLint ok = 0;
    gl.GetProgramiv(program.id_, GL_LINK_STATUS, &ok);
    if (ok != GL_TRUE)
        return Error{ErrorCode::unavailable, "the driver does not link a shader: " +
                                                 log_of(gl.GetProgramiv, gl.GetProgramInfoLog, program.id_)};
    return Result<Program>(std::move(program));
}

Program::Program(Program&& other) noexcept : gl_(other.gl_), id_(std::exchange(other.id_, 0)) {}

Program::~Program() {
    if (id_ != 0) gl_->DeleteProgram(id_);
}

DetailTextures::DetailTextures(const Functions& gl, const PackedTextures& textures, const PathDetail& detail,
                               const RgbaImage& residual, const std::vector<std::uint32_t>& charts)
    : gl_(gl),
      detail_(detail),
      sections_(textures.sections),
      data_width_(textures.data_width),
      grid_width_(textures.grid_width),
      grid_height_(textures.grid_height),
      drop_range_(drop_range(textures, detail)),
      has_residual_(residual.width > 0) {
    names_[0] = make_texture(gl, GL_RG32UI, GL_RG_INTEGER, grid_width_, grid_height_, textures.grid, 2);
    names_[1] =
        make_texture(gl, GL_RGBA32UI, GL_RGBA_INTEGER, data_width_, textures.data_height, textures.data, 4);
    names_[2] = make_residual(gl, residual, detail.repeat);
    if (!charts.empty())
        names_[4] = make_texture(gl, GL_RGBA32UI, GL_RGBA_INTEGER, detail.charts.width, detail.charts.height, charts, 4);
    if (textures.sections.end() > 0) {
        Prefilter filter = prefilter_pattern(textures, detail);
        names_[3] = make_prefilter(gl, filter, detail.repeat);
        classes_ = std::move(filter.classes);
    } else {
        names_[3] = make_prefilter(gl, {}, detail.repeat);
    }
}

DetailTextures::~DetailTextures() { gl_.DeleteTextures(5, names_); }

void DetailTextures::bind(const Program& program) const {
    for (int i = 0; i < 2; ++i) {
        gl_.ActiveTexture(GLenum(GL_TEXTURE0 + i));
        gl_.BindTexture(GL_TEXTURE_2D, names_[i]);
    }
    gl_.ActiveTexture(GLenum(GL_TEXTURE0 + kResidualUnit));
    gl_.BindTexture(GL_TEXTURE_2D, names_[2]);
    program.set("burin_residual", kResidualUnit);
    program.set("burin_residual_scale", has_residual_ ? float(detail_.residual_scale) : 0.0f);
    gl_.ActiveTexture(GLenum(GL_TEXTURE0 + kPrefilterUnit));
    gl_.BindTexture(GL_TEXTURE_2D_ARRAY, names_[3]);
    program.set("burin_prefilter", kPrefilterUnit);
    program.set("burin_class_count", int(classes_.size()));
    for (std::size_t k = 0; k < classes_.size(); ++k) {
        const PrefilterClass& kind = classes_[k];
        gl_.Uniform4f(program.at(("burin_classes[" + std::to_string(k) + "]").c_str()), float(kind.style),
                      float(kind.tangent.x), float(kind.tangent.y), float(kind.height));
    }
    gl_.ActiveTexture(GLenum(GL_TEXTURE0 + kChartUnit));
    gl_.BindTexture(GL_TEXTURE_2D, names_[4] != 0 ? names_[4] : names_[1]);
    program.set("burin_chart_table", kChartUnit);
    const ChartLayout& layout = detail_.charts;
    program.set("burin_charts.origin", float(layout.origin[0]), float(layout.origin[1]));
    program.set("burin_charts.cell", float(layout.cell[0]), float(layout.cell[1]));
    const bool charted = names_[4] != 0;
    gl_.Uniform2i(program.at("burin_charts.cells"), charted ? layout.columns : 0, charted ? layout.rows : 0);
    program.set("burin_charts.first_cell", int(layout.first_cell()));
    program.set("burin_charts.first_reference", int(layout.first_reference()));
    program.set("burin_grid", 0);
    program.set("burin_data", 1);
    program.set("burin_data_width", data_width_);
    program.set("burin_map.size", float(detail_.size_u), float(detail_.size_v));
    program.set("burin_map.depth", float(detail_.depth));
    program.set("burin_map.outer_level", float(detail_.base_offset - detail_.outer_level));
    program.set("burin_map.drop_range", drop_range_[0], drop_range_[1]);
    program.set("burin_map.repeats", detail_.repeat ? 1 : 0);
    gl_.Uniform2i(program.at("burin_map.cells"), grid_width_, grid_height_);
    program.set("burin_map.first_style", int(sections_.styles_begin()));
    program.set("burin_map.first_profile", int(sections_.profiles_begin()));
    program.set("burin_map.first_material", int(sections_.materials_begin()));
    program.set("burin_map.first_list", int(sections_.lists_begin()));
    program.set("burin_map.first_function", int(sections_.functions_begin()));
}

Result<std::unique_ptr<FloatTarget>> FloatTarget::create(const Functions& gl, int width, int height,
                                                         int colors, bool depth) {
    std::unique_ptr<FloatTarget> target(new FloatTarget(gl, width, height));
    gl.GenFramebuffers(1, &target->framebuffer_);
    gl.BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer_);
    std::vector<GLenum> draw;
    for (int i = 0; i < colors + (depth ? 1 : 0); ++i) {
        const bool is_color = i < colors;
        GLuint buffer = 0;
        gl.GenRenderbuffers(1, &buffer);
        target->buffers_.push_back(buffer);
        gl.BindRenderbuffer(GL_RENDERBUFFER, buffer);
        gl.RenderbufferStorage(GL_RENDERBUFFER, is_color ? GL_RGBA32F : GL_DEPTH_COMPONENT32F, width, height);
        const GLenum attachment = is_color ? GLenum(GL_COLOR_ATTACHMENT0 + i) : GLenum(GL_DEPTH_ATTACHMENT);
        gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
        if (is_color) draw.push_back(attachment);
    }
    gl.DrawBuffers(GLsizei(draw.size()), draw.data());
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE || gl.GetError() != GL_NO_ERROR)
        return Error{ErrorCode::unavailable, "the driver has no float target of " + std::to_string(width) +
                                                 "x" + std::to_string(height) + " pixels"};
    return target;
}

FloatTarget::~FloatTarget() {
    gl_.DeleteRenderbuffers(GLsizei(buffers_.size()), buffers_.data());
    if (framebuffer_ != 0) gl_.DeleteFramebuffers(1, &framebuffer_);
}

void FloatTarget::bind() const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    gl_.Viewport(0, 0, width_, height_);
}

std::vector<float> FloatTarget::read(int color) const {
    std::vector<float> pixels(std::size_t(width_) * std::size_t(height_) * 4);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    gl_.ReadBuffer(GLenum(GL_COLOR_ATTACHMENT0 + color));
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl_.ReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, pixels.data());
    return pixels;
}

std::vector<float> FloatTarget::read_depths() const {
    std::vector<float> depths(std::size_t(width_) * std::size_t(height_));
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl_.ReadPixels(0, 0, width_, height_, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
    return depths;
}

}  // namespace burin::gl
