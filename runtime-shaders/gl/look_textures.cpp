#include "gl/look_textures.hpp"

#include <cmath>
#include <numbers>
#include <string>

namespace burin::gl {
namespace {

constexpr int kFirstUnit = 8;  // behind those of the pattern
constexpr int kRadianceUnit = 12, kReflectanceUnit = 13;

// The textures in the order of the shader's texture_sets.
std::array<const MaterialTexture*, 4> textures_of(const MaterialInfo& material) {
    return {&material.base_color_texture, &material.metallic_roughness_texture, &material.occlusion_texture, &material.emissive_texture};
}

bool is_color(std::size_t which) { return which == 0 || which == 3; }

GLuint make_picture(const Functions& gl, const MaterialTexture& texture, bool color) {
    GLuint name = 0;
    gl.GenTextures(1, &name);
    gl.BindTexture(GL_TEXTURE_2D, name);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    const std::uint8_t white[4] = {255, 255, 255, 255};
    const RgbaImage* image = texture.image.get();
    gl.TexImage2D(GL_TEXTURE_2D, 0, color ? GL_SRGB8_ALPHA8 : GL_RGBA8, image ? image->width : 1, image ? image->height : 1, 0, GL_RGBA,
                  GL_UNSIGNED_BYTE, image ? image->texels.data() : white);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, texture.minification);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, texture.magnification);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, texture.wrap_u);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, texture.wrap_v);
    gl.GenerateMipmap(GL_TEXTURE_2D);
    return name;
}

void bind_unit(const Functions& gl, const Program& program, const char* uniform, int unit, GLuint name) {
    gl.ActiveTexture(GLenum(GL_TEXTURE0 + unit));
    gl.BindTexture(GL_TEXTURE_2D, name);
    program.set(uniform, unit);
}

}  // namespace

int texture_kinds(const Asset& asset) {
    int kinds = 0;
    for (const MaterialInfo& material : asset.materials) {
        const auto textures = textures_of(material);
        for (std::size_t k = 0; k < textures.size(); ++k)
            if (textures[k]->image != nullptr) kinds |= 1 << k;
    }
    return kinds;
}

MaterialTextures::MaterialTextures(const Functions& gl, const MaterialInfo& material) : gl_(gl), material_(material) {
    const auto textures = textures_of(material);
    for (std::size_t k = 0; k < textures.size(); ++k) names_[k] = make_picture(gl, *textures[k], is_color(k));
}

MaterialTextures::~MaterialTextures() { gl_.DeleteTextures(4, names_); }

void MaterialTextures::bind(const Program& program) const {
    static constexpr const char* kUniforms[] = {"base_color_texture", "metallic_roughness_texture", "occlusion_texture", "emissive_texture"};
    const auto textures = textures_of(material_);
    GLint sets[4];
    for (std::size_t k = 0; k < 4; ++k) {
        bind_unit(gl_, program, kUniforms[k], kFirstUnit + int(k), names_[k]);
        const MaterialTexture& texture = *textures[k];
        sets[k] = texture.image == nullptr ? -1 : (texture.tex_coord == material_.detail.tex_coord ? 2 : texture.tex_coord);
        const auto& t = texture.transform;
        const std::string rows = "texture_rows[" + std::to_string(2 * k), next = "texture_rows[" + std::to_string(2 * k + 1);
        program.set((rows + "]").c_str(), t[0], t[1], t[2]);
        program.set((next + "]").c_str(), t[3], t[4], t[5]);
    }
    gl_.Uniform4i(program.at("texture_sets"), sets[0], sets[1], sets[2], sets[3]);
    const float* c = material_.base_color;
    gl_.Uniform4f(program.at("base_color"), c[0], c[1], c[2], c[3]);
    program.set("metallic", material_.metallic);
    program.set("roughness", material_.roughness);
    program.set("emissive", material_.emissive[0], material_.emissive[1], material_.emissive[2]);
    program.set("occlusion_strength", material_.occlusion_strength);
}

EnvironmentTextures::EnvironmentTextures(const Functions& gl, const PreparedEnvironment& environment)
    : gl_(gl), irradiance_(environment.irradiance), last_level_(int(environment.levels.size()) - 1) {
    gl_.GenTextures(2, names_);
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl_.BindTexture(GL_TEXTURE_2D, names_[0]);
    for (int k = 0; k <= last_level_; ++k) {
        const auto& level = environment.levels[std::size_t(k)];
        gl_.TexImage2D(GL_TEXTURE_2D, k, GL_RGB32F, level.width, level.height, 0, GL_RGB, GL_FLOAT, level.texels.data());
    }
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, last_level_);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl_.BindTexture(GL_TEXTURE_2D, names_[1]);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RG32F, ReflectanceTable::kSide, ReflectanceTable::kSide, 0, GL_RG, GL_FLOAT,
                   reflectance_table().terms.data());
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) gl_.TexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    for (const GLenum side : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) gl_.TexParameteri(GL_TEXTURE_2D, side, GL_CLAMP_TO_EDGE);
}

EnvironmentTextures::~EnvironmentTextures() { gl_.DeleteTextures(2, names_); }

void EnvironmentTextures::bind(const Program& program, double rotation, double strength) const {
    bind_unit(gl_, program, "environment_radiance", kRadianceUnit, names_[0]);
    bind_unit(gl_, program, "environment_reflectance", kReflectanceUnit, names_[1]);
    program.set("environment_levels", float(last_level_));
    for (std::size_t k = 0; k < 9; ++k)
        program.set(("environment_terms[" + std::to_string(k) + "]").c_str(), irradiance_[k][0], irradiance_[k][1], irradiance_[k][2]);
    program.set("environment_strength", float(strength));
    const double turn = rotation * std::numbers::pi / 180.0;
    program.set("environment_turn", float(std::cos(turn)), float(std::sin(turn)));
}

}  // namespace burin::gl
