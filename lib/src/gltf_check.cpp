// Every index, view, accessor, primitive and node that burin follows.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "gltf_geometry.hpp"

namespace burin {
namespace {

// Sums of the document stay far from overflow when every number is below this.
constexpr std::uint64_t kMaxNumber = 1ull << 40;

class Checker {
  public:
    explicit Checker(const ModelData& model) : model_(model), document_(model.document) {}

    Status run() {
        // bounds_[accessor] fills while primitives are checked; accessors may be shared by many.
        bounds_.resize(list("accessors").size());
        for (bool (Checker::*step)() :
             {&Checker::views, &Checker::images, &Checker::accessors, &Checker::materials, &Checker::meshes,
              &Checker::skins, &Checker::nodes, &Checker::scenes}) {
            if (!(this->*step)()) return error_;
        }
        return Done{};
    }

  private:
    const Json& list(const char* key) const { return array_of(document_, key); }

    bool fail(const std::string& message) {
        error_ = model_error("glTF: " + message);
        return false;
    }

    // An unsigned integer below kMaxNumber; absent: `fallback`, or an error when there is none.
    bool number(const Json& object, const char* key, const std::string& where,
                std::optional<std::uint64_t> fallback, std::uint64_t& out) {
        const Json* value = find_member(object, key);
        if (value == nullptr && fallback.has_value()) {
            out = *fallback;
            return true;
        }
        if (value == nullptr) return fail(where + ": " + key + " is missing");
        if (!value->is_number_unsigned() || value->get<std::uint64_t>() >= kMaxNumber)
            return fail(where + ": " + key + " is no unsigned integer below 2^40");
        out = value->get<std::uint64_t>();
        return true;
    }

    // An optional member that must point into a list.
    bool reference(const Json& object, const char* key, const char* array, const std::string& where) {
        std::uint64_t index = 0;
        if (!object.contains(key)) return true;
        if (!number(object, key, where, std::nullopt, index)) return false;
        if (index >= list(array).size())
            return fail(where + ": " + key + " is " + std::to_string(index) + ", there are " +
                        std::to_string(list(array).size()) + " " + array);
        return true;
    }

    // An optional array whose members point into a list.
    bool references(const Json& object, const char* key, const char* array, const std::string& where) {
        const Json* values = find_member(object, key);
        if (values == nullptr) return true;
        if (!values->is_array()) return fail(where + ": " + key + " is no array");
        for (const Json& value : *values)
            if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= list(array).size())
                return fail(where + ": " + key + " holds something that is no index of " + array);
        return true;
    }

    bool views() {
        for (std::size_t i = 0; i < list("bufferViews").size(); ++i) {
            const Json& view = list("bufferViews")[i];
            const std::string where = place(document_, "bufferViews", i);
            std::uint64_t buffer = 0, offset = 0, length = 0, stride = 0;
            if (!number(view, "buffer", where, std::nullopt, buffer) ||
                !reference(view, "buffer", "buffers", where) ||
                !number(view, "byteOffset", where, 0, offset) ||
                !number(view, "byteLength", where, std::nullopt, length) ||
                !number(view, "byteStride", where, 0, stride))
                return false;
            const std::uint64_t size = model_.buffers[buffer].size();
            if (length == 0 || offset > size || length > size - offset)
                return fail(where + ": bytes " + std::to_string(offset) + " to " +
                            std::to_string(offset + length) + " of buffer " + std::to_string(buffer) +
                            ", which has " + std::to_string(size));
            if (view.contains("byteStride") && (stride < 4 || stride > 252 || stride % 4 != 0))
                return fail(where + ": byteStride is " + std::to_string(stride) +
                            ", it must be 4 to 252 in steps of 4");
            for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
                if (const Json* e = find_member(view, "extensions"); e != nullptr && e->contains(name)) {
                    error_ = Error{ErrorCode::unsupported,
                                   "glTF: " + where + " is coded with " + name +
                                       ", which is not supported; save the model without it"};
                    return false;
                }
        }
        return true;
    }

    bool images() {
        for (std::size_t i = 0; i < list("images").size(); ++i) {
            const Json& image = list("images")[i];
            const std::string where = place(document_, "images", i);
            if (!reference(image, "bufferView", "bufferViews", where)) return false;
            if (const Json* type = find_member(image, "mimeType"); type != nullptr && !type->is_string())
                return fail(where + ": mimeType is no text");
        }
        for (std::size_t i = 0; i < list("textures").size(); ++i) {
            const std::string where = place(document_, "textures", i);
            if (!reference(list("textures")[i], "source", "images", where) ||
                !reference(list("textures")[i], "sampler", "samplers", where))
                return false;
        }
        return true;
    }

    // `count` elements of `size` bytes, `stride` apart, from `offset` of a view.
    bool fits_view(const Json& user, const std::string& where, std::uint64_t size, std::uint64_t component,
                   std::uint64_t count, bool may_stride) {
        std::uint64_t index = 0, offset = 0;
        if (!number(user, "bufferView", where, std::nullopt, index) ||
            !reference(user, "bufferView", "bufferViews", where) ||
            !number(user, "byteOffset", where, 0, offset))
            return false;
        const Json& view = list("bufferViews")[index];
        const std::uint64_t stride = unsigned_or(view, "byteStride", size),
                            length = unsigned_or(view, "byteLength", 0);
        if (view.contains("byteStride") && !may_stride)
            return fail(where + ": its bufferView may have no byteStride");
        if (stride < size)
            return fail(where + ": elements of " + std::to_string(size) + " bytes, byteStride " +
                        std::to_string(stride));
        if ((offset + unsigned_or(view, "byteOffset", 0)) % component != 0 || stride % component != 0)
            return fail(where + ": its elements do not start on multiples of their component's " +
                        std::to_string(component) + " bytes");
        if (offset > length || size > length - offset || (count - 1) > (length - offset - size) / stride)
            return fail(where + ": " + std::to_string(count) + " elements of " + std::to_string(size) +
                        " bytes do not fit into bufferView " + std::to_string(index) + " of " +
                        std::to_string(length));
        return true;
    }

    bool accessors() {
        for (std::size_t i = 0; i < list("accessors").size(); ++i)
            if (!accessor(list("accessors")[i], place(document_, "accessors", i))) return false;
        return true;
    }

    bool accessor(const Json& item, const std::string& where) {
        std::uint64_t type = 0, count = 0, offset = 0;
        if (!number(item, "componentType", where, std::nullopt, type) ||
            !number(item, "count", where, std::nullopt, count) ||
            !number(item, "byteOffset", where, 0, offset))
            return false;
        const AccessorKind kind = accessor_kind(item);
        if (kind.component_bytes == 0) return fail(where + ": unknown componentType " + std::to_string(type));
        if (kind.components == 0) return fail(where + ": unknown type '" + text_or(item, "type", "") + "'");
        if (count == 0 || count > kMaxModelIndices)
            return fail(where + ": count is " + std::to_string(count) + ", it must be 1 to " +
                        std::to_string(kMaxModelIndices));
        // Zeros without a view cost no byte of the file, so that only a limit keeps them small.
        constexpr std::uint64_t kMaxImplicit = 1u << 22;
        if (!item.contains("bufferView") && count > kMaxImplicit)
            return fail(where + ": " + std::to_string(count) + " elements without a bufferView, limit " +
                        std::to_string(kMaxImplicit));
        const auto component = static_cast<std::uint64_t>(kind.component_bytes);
        if (item.contains("bufferView") &&
            !fits_view(item, where, kind.element_bytes, component, count, true))
            return false;
        return !item.contains("sparse") || sparse(item, where, kind, count);
    }

    bool sparse(const Json& item, const std::string& where, const AccessorKind& kind, std::uint64_t count) {
        const Json& part = item["sparse"];
        const Json *indices = find_member(part, "indices"), *values = find_member(part, "values");
        if (indices == nullptr || values == nullptr || !indices->is_object() || !values->is_object())
            return fail(where + ": sparse has no indices or no values");
        std::uint64_t number_of = 0, type = 0, unused = 0;
        if (!number(part, "count", where + ".sparse", std::nullopt, number_of) ||
            !number(*indices, "componentType", where + ".sparse", std::nullopt, type) ||
            !number(*indices, "byteOffset", where, 0, unused) ||
            !number(*values, "byteOffset", where, 0, unused))
            return false;
        const std::uint64_t size = type == 5121 ? 1 : type == 5123 ? 2 : type == 5125 ? 4 : 0;
        if (number_of == 0 || number_of > count)
            return fail(where + ": sparse.count is " + std::to_string(number_of) + ", it must be 1 to " +
                        std::to_string(count));
        if (size == 0) return fail(where + ": sparse indices have componentType " + std::to_string(type));
        if (!fits_view(*indices, where + ".sparse.indices", size, size, number_of, false) ||
            !fits_view(*values, where + ".sparse.values", kind.element_bytes,
                       static_cast<std::uint64_t>(kind.component_bytes), number_of, false))
            return false;
        return sparse_indices(*indices, where, size, number_of, count);
    }

    bool sparse_indices(const Json& indices, const std::string& where, std::uint64_t size,
                        std::uint64_t number_of, std::uint64_t count) {
        const Json& view = list("bufferViews")[unsigned_or(indices, "bufferView", 0)];
        const auto& bytes = model_.buffers[unsigned_or(view, "buffer", 0)];
        const std::uint64_t begin =
            unsigned_or(view, "byteOffset", 0) + unsigned_or(indices, "byteOffset", 0);
        std::uint64_t previous = 0;
        for (std::uint64_t i = 0; i < number_of; ++i) {
            std::uint64_t index = 0;
            for (std::uint64_t b = 0; b < size; ++b)
                index |= static_cast<std::uint64_t>(bytes[begin + i * size + b]) << (8 * b);
            if (index >= count || (i > 0 && index <= previous))
                return fail(where + ": sparse index " + std::to_string(i) + " is " + std::to_string(index) +
                            ", it must grow and stay below " + std::to_string(count));
            previous = index;
        }
        return true;
    }

    bool materials() {
        for (std::size_t i = 0; i < list("materials").size(); ++i) {
            const Json& material = list("materials")[i];
            const std::string where = place(document_, "materials", i);
            if (const Json* pbr = find_member(material, "pbrMetallicRoughness"); pbr != nullptr) {
                if (!pbr->is_object()) return fail(where + ": pbrMetallicRoughness is no object");
                if (!texture(*pbr, "baseColorTexture", where) ||
                    !texture(*pbr, "metallicRoughnessTexture", where))
                    return false;
            }
            for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"})
                if (!texture(material, key, where)) return false;
        }
        return true;
    }

    bool texture(const Json& owner, const char* key, const std::string& where) {
        const Json* info = find_member(owner, key);
        if (info == nullptr) return true;
        if (!info->is_object() || !info->contains("index"))
            return fail(where + ": " + key + " is no object with an index");
        return reference(*info, "index", "textures", where + "." + key);
    }

    bool meshes() {
        for (std::size_t i = 0; i < list("meshes").size(); ++i) {
            const std::string where = place(document_, "meshes", i);
            const Json* primitives = find_member(list("meshes")[i], "primitives");
            if (primitives == nullptr || !primitives->is_array() || primitives->empty())
                return fail(where + ": there are no primitives");
            for (std::size_t k = 0; k < primitives->size(); ++k)
                if (!primitive((*primitives)[k], where + ".primitives[" + std::to_string(k) + "]"))
                    return false;
        }
        return true;
    }

    bool primitive(const Json& item, const std::string& where) {
        if (!item.is_object()) return fail(where + " is no object");
        const Json* attributes = find_member(item, "attributes");
        if (attributes == nullptr || !attributes->is_object() || attributes->empty())
            return fail(where + ": there are no attributes");
        std::uint64_t mode = 0;
        if (!number(item, "mode", where, 4, mode) || !reference(item, "material", "materials", where) ||
            !reference(item, "indices", "accessors", where))
            return false;
        if (mode > 6) return fail(where + ": mode is " + std::to_string(mode) + ", it must be 0 to 6");
        if (!attributes->contains("POSITION")) {
            if (const Json* e = find_member(item, "extensions"); e != nullptr && !e->empty())
                return fail(where + ": no POSITION; it may be compressed, which is not supported");
            return fail(where + ": there is no POSITION attribute");
        }
        std::optional<std::uint64_t> count;
        for (const auto& [name, unused] : attributes->items()) {
            if (!reference(*attributes, name.c_str(), "accessors", where)) return false;
            if (!attribute(name, (*attributes)[name].get<std::size_t>(), where, count)) return false;
        }
        return index_accessor(item, where, *count) && targets(item, where, *count);
    }

    bool attribute(const std::string& name, std::size_t index, const std::string& where,
                   std::optional<std::uint64_t>& count) {
        const Json& item = list("accessors")[index];
        const std::string here = where + "." + name;
        const std::uint64_t elements = unsigned_or(item, "count", 0);
        if (count.has_value() && *count != elements)
            return fail(here + " has " + std::to_string(elements) + " elements, the attribute before it " +
                        std::to_string(*count));
        count = elements;
        const std::string type = text_or(item, "type", "");
        const bool vector3 = name == "POSITION" || name == "NORMAL";
        if ((vector3 && type != "VEC3") || (name == "TANGENT" && type != "VEC4") ||
            (name.rfind("TEXCOORD_", 0) == 0 && type != "VEC2"))
            return fail(here + " is of type " + type);
        if (elements > kMaxModelVertices)
            return fail(here + ": " + std::to_string(elements) + " vertices, limit " +
                        std::to_string(kMaxModelVertices));
        if (!vector3 && name.rfind("TEXCOORD_", 0) != 0 && name != "TANGENT") return true;
        if (bounds(index).finite) return true;
        return fail(here + ": element " + std::to_string(bounds(index).not_finite) +
                    " is not a finite number");
    }

    bool index_accessor(const Json& item, const std::string& where, std::uint64_t count) {
        if (!item.contains("indices")) return true;
        const auto index = item["indices"].get<std::size_t>();
        const Json& accessor_item = list("accessors")[index];
        const std::uint64_t type = unsigned_or(accessor_item, "componentType", 0);
        if (text_or(accessor_item, "type", "") != "SCALAR" || (type != 5121 && type != 5123 && type != 5125))
            return fail(where + ": indices are no unsigned scalars");
        if (bounds(index).greatest >= count)
            return fail(where + ": an index is " + std::to_string(bounds(index).greatest) + ", there are " +
                        std::to_string(count) + " vertices");
        return true;
    }

    bool targets(const Json& item, const std::string& where, std::uint64_t count) {
        const Json* list_of = find_member(item, "targets");
        if (list_of == nullptr) return true;
        if (!list_of->is_array()) return fail(where + ": targets is no array");
        for (const Json& target : *list_of) {
            if (!target.is_object()) return fail(where + ": a target is no object");
            for (const auto& [name, unused] : target.items()) {
                if (!reference(target, name.c_str(), "accessors", where + ".targets")) return false;
                if (unsigned_or(list("accessors")[target[name].get<std::size_t>()], "count", 0) != count)
                    return fail(where + ".targets: " + name + " has another count than the vertices");
            }
        }
        return true;
    }

    bool skins() {
        for (std::size_t i = 0; i < list("skins").size(); ++i) {
            const Json& skin = list("skins")[i];
            const std::string where = place(document_, "skins", i);
            if (!reference(skin, "inverseBindMatrices", "accessors", where) ||
                !reference(skin, "skeleton", "nodes", where) || !references(skin, "joints", "nodes", where))
                return false;
        }
        return true;
    }

    bool finite_numbers(const Json& object, const char* key, std::size_t count, const std::string& where) {
        const Json* values = find_member(object, key);
        if (values == nullptr) return true;
        bool good = values->is_array() && values->size() == count;
        for (std::size_t i = 0; good && i < count; ++i)
            good = (*values)[i].is_number() && std::abs((*values)[i].get<double>()) <= 1e30;
        return good ||
               fail(where + ": " + key + " is no array of " + std::to_string(count) + " numbers within 1e30");
    }

    bool nodes() {
        const Json& all = list("nodes");
        parents_.assign(all.size(), 0);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const std::string where = place(document_, "nodes", i);
            const Json& node = all[i];
            if (!reference(node, "mesh", "meshes", where) || !reference(node, "skin", "skins", where) ||
                !reference(node, "camera", "cameras", where) ||
                !references(node, "children", "nodes", where) || !finite_numbers(node, "matrix", 16, where) ||
                !finite_numbers(node, "translation", 3, where) ||
                !finite_numbers(node, "rotation", 4, where) || !finite_numbers(node, "scale", 3, where))
                return false;
            for (const Json& child : array_of(node, "children"))
                if (++parents_[child.get<std::size_t>()] > 1)
                    return fail(place(document_, "nodes", child.get<std::size_t>()) +
                                " is a child of two nodes");
        }
        return no_loop();
    }

    // With one parent at most for each node, whatever cannot be reached from the roots lies on a loop.
    bool no_loop() {
        std::vector<std::size_t> open;
        for (std::size_t i = 0; i < parents_.size(); ++i)
            if (parents_[i] == 0) open.push_back(i);
        std::size_t reached = 0;
        while (!open.empty()) {
            const std::size_t node = open.back();
            open.pop_back();
            ++reached;
            for (const Json& child : array_of(list("nodes")[node], "children"))
                open.push_back(child.get<std::size_t>());
        }
        return reached == parents_.size() || fail("nodes form a loop");
    }

    bool scenes() {
        for (std::size_t i = 0; i < list("scenes").size(); ++i) {
            const std::string where = place(document_, "scenes", i);
            if (!references(list("scenes")[i], "nodes", "nodes", where)) return false;
            // A node twice in a scene, or a root below another one, would be drawn twice.
            std::vector<std::uint64_t> roots;
            for (const Json& node : array_of(list("scenes")[i], "nodes")) {
                roots.push_back(node.get<std::uint64_t>());
                if (parents_[roots.back()] != 0)
                    return fail(where + ": " + place(document_, "nodes", roots.back()) + " is no root");
            }
            std::sort(roots.begin(), roots.end());
            if (std::adjacent_find(roots.begin(), roots.end()) != roots.end())
                return fail(where + ": a node stands there twice");
        }
        return reference(document_, "scene", "scenes", "the document");
    }

    // What one pass over an accessor's values tells.
    struct Bounds {
        bool known = false;
        bool finite = true;
        std::size_t not_finite = 0;  // element
        std::uint64_t greatest = 0;  // of unsigned scalars
    };

    const Bounds& bounds(std::size_t index) {
        Bounds& b = bounds_[index];
        if (b.known) return b;
        b.known = true;
        const Json& item = list("accessors")[index];
        const AccessorKind kind = accessor_kind(item);
        const std::uint64_t type = unsigned_or(item, "componentType", 0);
        if (type == 5126) {
            const std::vector<float> values = read_numbers(model_, index);
            for (std::size_t i = 0; i < values.size() && b.finite; ++i) {
                b.finite = std::isfinite(values[i]);
                b.not_finite = i / static_cast<std::size_t>(kind.components);
            }
        } else if (kind.components == 1) {
            for (const std::uint32_t value : read_indices(model_, index))
                b.greatest = std::max<std::uint64_t>(b.greatest, value);
        }
        return b;
    }

    const ModelData& model_;
    const Json& document_;
    std::vector<Bounds> bounds_;
    std::vector<std::size_t> parents_;  // number of them, by node
    Error error_;
};

}  // namespace

Status check_document(const ModelData& model) { return Checker(model).run(); }

}  // namespace burin
