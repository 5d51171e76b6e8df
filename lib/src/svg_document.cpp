#include "svg_document.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace burin::svg {
namespace {

constexpr double kMetresPerPixel = 0.0254 / 96.0;
constexpr std::string_view kDataPrefix = "data-burin-";

Error refuse(const std::string& what) { return {ErrorCode::invalid_input, what}; }

// Elements that hold what others refer to, or words about the drawing.
bool is_silent(std::string_view name) {
    static constexpr std::string_view kSilent[] = {"clipPath", "defs", "desc", "filter", "font", "linearGradient", "marker", "mask", "metadata",
                                                   "namedview", "pattern", "radialGradient", "script", "style", "symbol", "title", "view",
                                                   "meshgradient", "hatch", "color-profile", "font-face", "cursor", "animate", "animateMotion",
                                                   "animateTransform", "set", "PageFont", "pgf", "aliases", "variableSets", "sliceOptions"};
    return std::find(std::begin(kSilent), std::end(kSilent), name) != std::end(kSilent);
}

struct Viewport {
    double width = 0.0, height = 0.0;  // what 100 % are, user units
    double diagonal() const { return std::hypot(width, height) / std::sqrt(2.0); }
};

// What is handed down to an element.
struct State {
    Affine to_pattern;
    Style style;
    std::shared_ptr<const Names> names;
    Viewport viewport;
    int depth = 0;
};

class Reader {
  public:
    Reader(std::string_view text, const DocumentOptions& options, std::vector<Subpath>* guide) : text_(text), options_(options), guide_(guide) {}

    Result<Document> read() {
        if (text_.size() > kMaxSvgBytes)
            return Error{ErrorCode::limit_exceeded, "the drawing has " + std::to_string(text_.size()) + " bytes; at most " + std::to_string(kMaxSvgBytes) + " are read"};
        const pugi::xml_parse_result parsed = xml_.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
        if (!parsed) return refuse("line " + std::to_string(line_at(parsed.offset)) + ": not well-formed XML: " + parsed.description());
        const pugi::xml_node root = xml_.document_element();
        if (!root || local_name(root.name()) != "svg")
            return refuse("no drawing: the outermost element is '" + std::string(root ? root.name() : "") + "', where svg would work");
        collect(root);
        State state;
        state.names = std::make_shared<Names>();
        if (const Status placed = place_page(root, state); !placed) return placed.error();
        tolerance_ = options_.tolerance > 0.0 ? options_.tolerance : 5e-5 * std::max(out_.size.x, out_.size.y);
        state.style = sheet_.computed(root, {});
        if (const Status walked = walk_children(root, state); !walked) return walked.error();
        for (const std::string& one : sheet_.passed_over()) out_.notes.add("style rule '" + one + "' is not read", "style");
        if (!options_.text_path.empty() && !guided_) return refuse("no path with the id '" + options_.text_path + "' to guide the text");
        return std::move(out_);
    }

  private:
    std::size_t line_at(std::ptrdiff_t offset) {
        if (line_ends_.empty()) {
            for (std::size_t i = 0; i < text_.size(); ++i)
                if (text_[i] == '\n') line_ends_.push_back(std::ptrdiff_t(i));
            line_ends_.push_back(std::ptrdiff_t(text_.size()) + 1);
        }
        return 1 + std::size_t(std::lower_bound(line_ends_.begin(), line_ends_.end(), offset) - line_ends_.begin());
    }
    std::string place_of(const pugi::xml_node& node) {
        const char* id = node.attribute("id").value();
        return "line " + std::to_string(line_at(node.offset_debug())) + ", " + node.name() + (*id != 0 ? std::string(" '") + id + "'" : "");
    }

    // Style sheets and ids, wherever they stand.
    void collect(const pugi::xml_node& root) {
        for (pugi::xml_node node = root; node; node = next_of(node, root)) {
            if (const pugi::xml_attribute id = node.attribute("id")) ids_.emplace(id.value(), node);
            if (local_name(node.name()) != "style") continue;
            std::string css;
            for (const pugi::xml_node& part : node.children()) css += part.value();
            sheet_.add(css);
        }
    }
    // In the order of the document, without recursion.
    static pugi::xml_node next_of(pugi::xml_node node, const pugi::xml_node& root) {
        if (node.first_child()) return node.first_child();
        while (node != root && !node.next_sibling()) node = node.parent();
        return node == root ? pugi::xml_node() : node.next_sibling();
    }

    static std::map<std::string, std::string> data_of(const pugi::xml_node& node) {
        std::map<std::string, std::string> data;
        for (const pugi::xml_attribute& attribute : node.attributes())
            if (std::string_view(attribute.name()).starts_with(kDataPrefix)) data[attribute.name() + kDataPrefix.size()] = attribute.value();
        return data;
    }

    Status place_page(const pugi::xml_node& root, State& state) {
        out_.root_data = data_of(root);
        out_.own = out_.root_data.contains("version");
        if (out_.own) return place_own_page(root, state);
        const auto box = view_box_of(root);
        if (!box) return box.error();
        const Vec2 usual = (*box) ? Vec2{(*box)->at(2), (*box)->at(3)} : Vec2{300.0, 150.0};
        Vec2 sides = usual;  // CSS pixels
        for (const auto& [name, side, other] : {std::tuple{"width", &sides.x, usual.x}, std::tuple{"height", &sides.y, usual.y}}) {
            const std::string_view text = trimmed(root.attribute(name).value());
            if (text.empty() || text == "auto" || text.ends_with('%')) continue;
            const auto length = parse_length(text, other);
            if (!length || !(*length > 0.0))
                return refuse(place_of(root) + ": " + name + " '" + std::string(text) + "' is no length above 0, such as 210mm");
            *side = *length;
        }
        // One side alone keeps the shape of the view box.
        const bool has_width = usable(root, "width"), has_height = usable(root, "height");
        if (*box && has_width && !has_height) sides.y = sides.x * usual.y / usual.x;
        if (*box && has_height && !has_width) sides.x = sides.y * usual.x / usual.y;
        double metres = kMetresPerPixel;
        if (options_.width) metres = *options_.width / sides.x;
        else if (options_.height) metres = *options_.height / sides.y;
        out_.size = sides * metres;
        if (options_.width && options_.height) {
            if (std::abs(*options_.height / out_.size.y - 1.0) > 0.01)
                return Error{ErrorCode::invalid_argument, "a size of " + std::to_string(*options_.width) + " x " + std::to_string(*options_.height) +
                                                              " m would stretch the page, which is " + std::to_string(out_.size.x) + " x " + std::to_string(out_.size.y) + " m at that width"};
            out_.size.y = *options_.height;
        }
        const std::string fit = root.attribute("preserveAspectRatio").value();
        state.to_pattern = Affine{metres, 0, 0, metres, 0, 0} * (*box ? fit_box(**box, {0, 0, sides.x, sides.y}, fit) : Affine{});
        state.viewport = *box ? Viewport{(*box)->at(2), (*box)->at(3)} : Viewport{sides.x, sides.y};
        return Done{};
    }
    static bool usable(const pugi::xml_node& root, const char* name) {
        const std::string_view text = trimmed(root.attribute(name).value());
        return !text.empty() && text != "auto" && !text.ends_with('%');
    }

    Status place_own_page(const pugi::xml_node& root, State& state) {
        const auto size = parse_numbers(out_.root_data["size"]);
        if (!size || size->size() != 2 || !((*size)[0] > 0.0 && (*size)[1] > 0.0))
            return refuse(place_of(root) + ": data-burin-size '" + out_.root_data["size"] + "' is no pair of lengths above 0, in metres");
        out_.size = {(*size)[0], (*size)[1]};
        state.viewport = {out_.size.x, out_.size.y};
        for (std::size_t n = 0;; ++n) {
            const auto found = ids_.find("profile-" + std::to_string(n));
            if (found == ids_.end()) break;
            out_.profiles.push_back(data_of(found->second));
            out_.profiles.back()["place"] = place_of(found->second);
        }
        return Done{};
    }

    // Nothing where there is no view box.
    Result<std::optional<std::array<double, 4>>> view_box_of(const pugi::xml_node& node) {
        const pugi::xml_attribute attribute = node.attribute("viewBox");
        if (!attribute) return std::optional<std::array<double, 4>>{};
        const auto numbers = parse_numbers(attribute.value());
        if (!numbers || numbers->size() != 4 || !((*numbers)[2] > 0.0 && (*numbers)[3] > 0.0))
            return refuse(place_of(node) + ": viewBox '" + attribute.value() + "' is not x y width height, with both sides above 0");
        return std::optional(std::array{(*numbers)[0], (*numbers)[1], (*numbers)[2], (*numbers)[3]});
    }

    // The view box put into a frame (x, y, width, height), as preserveAspectRatio says.
    static Affine fit_box(const std::array<double, 4>& box, const std::array<double, 4>& frame, const std::string& fit) {
        double sx = frame[2] / box[2], sy = frame[3] / box[3], dx = 0.0, dy = 0.0;
        if (!fit.starts_with("none")) {
            const bool slice = fit.find("slice") != std::string::npos;
            sx = sy = slice ? std::max(sx, sy) : std::min(sx, sy);
            const auto share = [&](const char* low, const char* high) {
                return fit.find(low) != std::string::npos ? 0.0 : fit.find(high) != std::string::npos ? 1.0 : 0.5;
            };
            dx = share("xMin", "xMax") * (frame[2] - sx * box[2]);
            dy = share("YMin", "YMax") * (frame[3] - sy * box[3]);
        }
        return {sx, 0, 0, sy, frame[0] + dx - sx * box[0], frame[1] + dy - sy * box[1]};
    }

    Status walk_children(const pugi::xml_node& parent, const State& state) {
        for (const pugi::xml_node& child : parent.children()) {
            if (child.type() != pugi::node_element) continue;
            if (const Status walked = walk(child, state); !walked) return walked;
        }
        return Done{};
    }

    Status walk(const pugi::xml_node& node, const State& outer) {
        const std::string_view name = local_name(node.name());
        if (is_silent(name) || std::strchr(node.name(), ':') != nullptr) return Done{};
        if (outer.depth >= kMaxSvgDepth)
            return Error{ErrorCode::limit_exceeded, place_of(node) + ": groups and uses are nested more than " + std::to_string(kMaxSvgDepth) + " deep"};
        State state = outer;
        ++state.depth;
        state.style = sheet_.computed(node, outer.style);
        if (state.style[Property::display] == "none") return Done{};
        if (const Status turned = add_transform(node, state); !turned) return turned;
        add_names(node, state);
        note_effects(node, state);
        if (name == "g" || name == "a") return walk_children(node, state);
        if (name == "svg") return walk_nested(node, state);
        if (name == "switch") return walk_switch(node, state);
        if (name == "use") return walk_use(node, state);
        return add_shape(node, name, state);
    }

    Status add_transform(const pugi::xml_node& node, State& state) {
        const pugi::xml_attribute attribute = node.attribute("transform");
        if (!attribute) return Done{};
        const auto transform = parse_transform(attribute.value());
        if (!transform) return refuse(place_of(node) + ": transform '" + attribute.value() + "' is not understood; such as translate(1 2) rotate(30)");
        state.to_pattern = state.to_pattern * *transform;
        return Done{};
    }

    void add_names(const pugi::xml_node& node, State& state) const {
        auto names = std::make_shared<Names>();
        names->outer = state.names;
        names->id = node.attribute("id").value();
        names->layer = node.attribute("inkscape:label").value();
        names->classes = split_words(node.attribute("class").value());
        names->data = data_of(node);
        const bool says = !names->id.empty() || !names->layer.empty() || !names->classes.empty() || !names->data.empty();
        if (says) state.names = std::move(names);
    }

    void note_effects(const pugi::xml_node& node, const State& state) {
        constexpr std::pair<Property, const char*> kEffects[] = {{Property::filter, "filter"}, {Property::mask, "mask"}, {Property::clip_path, "clip-path"}};
        for (const auto& [property, name] : kEffects)
            if (const std::string& value = state.style[property]; !value.empty() && value != "none")
                out_.notes.add(std::string(name) + " is not applied", place_of(node));
    }

    Status walk_nested(const pugi::xml_node& node, State state) {
        return walk_viewport(node, state, length_of(node, "x", state.viewport.width, 0.0), length_of(node, "y", state.viewport.height, 0.0),
                             length_of(node, "width", state.viewport.width, state.viewport.width),
                             length_of(node, "height", state.viewport.height, state.viewport.height));
    }

    Status walk_viewport(const pugi::xml_node& node, State state, double x, double y, double width, double height) {
        const auto box = view_box_of(node);
        if (!box) return box.error();
        if (!(width > 0.0 && height > 0.0)) return Done{};
        if (*box) {
            state.to_pattern = state.to_pattern * fit_box(**box, {x, y, width, height}, node.attribute("preserveAspectRatio").value());
            state.viewport = {(*box)->at(2), (*box)->at(3)};
        } else {
            state.to_pattern = state.to_pattern * Affine{1, 0, 0, 1, x, y};
            state.viewport = {width, height};
        }
        return walk_children(node, state);
    }

    // The first child that a program like this can show.
    Status walk_switch(const pugi::xml_node& node, const State& state) {
        for (const pugi::xml_node& child : node.children()) {
            if (child.type() != pugi::node_element || child.attribute("requiredExtensions")) continue;
            if (local_name(child.name()) == "foreignObject") continue;
            return walk(child, state);
        }
        return Done{};
    }

    Status walk_use(const pugi::xml_node& node, State state) {
        const pugi::xml_attribute plain = node.attribute("href");
        const std::string_view href = plain ? plain.value() : node.attribute("xlink:href").value();
        if (!href.starts_with('#')) {
            out_.notes.add("use of '" + std::string(href) + "' is left out; only elements of the same file can be used", place_of(node));
            return Done{};
        }
        const auto found = ids_.find(std::string(href.substr(1)));
        if (found == ids_.end()) return refuse(place_of(node) + ": there is no element with the id '" + std::string(href.substr(1)) + "'");
        const double x = length_of(node, "x", state.viewport.width, 0.0), y = length_of(node, "y", state.viewport.height, 0.0);
        if (out_.own && shows_wrap(node, href, x, y)) return Done{};
        if (++uses_ > kMaxSvgUses)
            return Error{ErrorCode::limit_exceeded, place_of(node) + ": more than " + std::to_string(kMaxSvgUses) + " uses, with those within others"};
        state.to_pattern = state.to_pattern * Affine{1, 0, 0, 1, x, y};
        const pugi::xml_node target = found->second;
        if (local_name(target.name()) != "symbol") return walk(target, state);
        return walk_viewport(target, state, 0.0, 0.0, length_of(node, "width", state.viewport.width, state.viewport.width),
                             length_of(node, "height", state.viewport.height, state.viewport.height));
    }

    // A clone that burin wrote to show a path coming back in at the other side (format/svg.md).
    bool shows_wrap(const pugi::xml_node& node, std::string_view href, double x, double y) const {
        const double i = x / out_.size.x, j = y / out_.size.y;
        return href.starts_with("#path-") && !node.attribute("transform") && std::abs(i - std::round(i)) < 1e-6 && std::abs(j - std::round(j)) < 1e-6;
    }

    static double length_of(const pugi::xml_node& node, const char* name, double percent_of, double usual) {
        return parse_length(node.attribute(name).value(), percent_of).value_or(usual);
    }

    Status add_shape(const pugi::xml_node& node, std::string_view name, const State& state) {
        PathPen pen(state.to_pattern, tolerance_);
        Shape shape;
        if (name == "path") {
            PathData data = parse_path_data(node.attribute("d").value(), state.to_pattern, tolerance_);
            if (!data.problem.empty()) out_.notes.add(data.problem + "; drawn as far as that", place_of(node));
            shape.outline = std::move(data.subpaths);
        } else if (name == "line" || name == "polyline" || name == "polygon") {
            if (!draw_points(node, name, state, pen)) return refuse(place_of(node) + ": points '" + node.attribute("points").value() + "' are no pairs of numbers");
            shape.fillable = name != "line";
        } else if (name == "rect") {
            draw_rect(node, state, pen);
        } else if (name == "circle" || name == "ellipse") {
            draw_ellipse(node, name, state, pen);
        } else {
            static constexpr std::string_view kKnown[] = {"text", "image", "foreignObject", "flowRoot"};
            const bool known = std::find(std::begin(kKnown), std::end(kKnown), name) != std::end(kKnown);
            out_.notes.add(std::string(known ? "" : "unknown element ") + std::string(name) + " is left out" +
                               (name == "text" || name == "flowRoot" ? "; convert it to paths, or use --text with a single-stroke font" : ""), place_of(node));
            return Done{};
        }
        if (name != "path") shape.outline = pen.finish();
        return keep(node, state, std::move(shape));
    }

    Status keep(const pugi::xml_node& node, const State& state, Shape shape) {
        if (!options_.text_path.empty() && options_.text_path == node.attribute("id").value()) {
            if (guide_) *guide_ = shape.outline;
            guided_ = true;
            return Done{};
        }
        const std::string& visibility = state.style[Property::visibility];
        if (shape.outline.empty() || visibility == "hidden" || visibility == "collapse") return Done{};
        for (const Subpath& subpath : shape.outline)
            for (const Element& e : subpath.elements)
                for (const Vec2 p : {e.p0, e.p1, e.p2})
                    if (!(std::abs(p.x) < 1e9 && std::abs(p.y) < 1e9)) return refuse(place_of(node) + ": a point lies at " + std::to_string(p.x) + ", " + std::to_string(p.y) + " m, far from any page");
        if (out_.shapes.size() >= kMaxSvgShapes)
            return Error{ErrorCode::limit_exceeded, place_of(node) + ": more than " + std::to_string(kMaxSvgShapes) + " shapes"};
        shape.place = place_of(node);
        shape.names = state.names;
        shape.style = state.style;
        shape.to_pattern = state.to_pattern;
        out_.shapes.push_back(std::move(shape));
        return Done{};
    }

    bool draw_points(const pugi::xml_node& node, std::string_view name, const State& state, PathPen& pen) const {
        const Viewport& v = state.viewport;
        if (name == "line") {
            pen.move_to({length_of(node, "x1", v.width, 0.0), length_of(node, "y1", v.height, 0.0)});
            pen.line_to({length_of(node, "x2", v.width, 0.0), length_of(node, "y2", v.height, 0.0)});
            return true;
        }
        const auto numbers = parse_numbers(node.attribute("points").value());
        if (!numbers || numbers->size() % 2 != 0) return false;
        for (std::size_t i = 0; i + 1 < numbers->size(); i += 2) {
            const Vec2 p{(*numbers)[i], (*numbers)[i + 1]};
            if (i == 0) pen.move_to(p);
            else pen.line_to(p);
        }
        if (name == "polygon") pen.close();
        return true;
    }

    static void draw_rect(const pugi::xml_node& node, const State& state, PathPen& pen) {
        const Viewport& v = state.viewport;
        const double x = length_of(node, "x", v.width, 0.0), y = length_of(node, "y", v.height, 0.0);
        const double w = length_of(node, "width", v.width, 0.0), h = length_of(node, "height", v.height, 0.0);
        if (!(w > 0.0 && h > 0.0)) return;
        double rx = length_of(node, "rx", v.width, -1.0), ry = length_of(node, "ry", v.height, -1.0);
        if (rx < 0.0) rx = ry;
        if (ry < 0.0) ry = rx;
        rx = std::clamp(rx, 0.0, 0.5 * w), ry = std::clamp(ry, 0.0, 0.5 * h);
        const bool round = rx > 0.0 && ry > 0.0;
        const auto corner = [&](Vec2 p) { if (round) pen.arc_to(rx, ry, 0.0, false, true, p); };
        if (!round) rx = ry = 0.0;
        pen.move_to({x + rx, y});
        pen.line_to({x + w - rx, y});
        corner({x + w, y + ry});
        pen.line_to({x + w, y + h - ry});
        corner({x + w - rx, y + h});
        pen.line_to({x + rx, y + h});
        corner({x, y + h - ry});
        pen.line_to({x, y + ry});
        corner({x + rx, y});
        pen.close();
    }

    static void draw_ellipse(const pugi::xml_node& node, std::string_view name, const State& state, PathPen& pen) {
        const Viewport& v = state.viewport;
        const double cx = length_of(node, "cx", v.width, 0.0), cy = length_of(node, "cy", v.height, 0.0);
        const bool circle = name == "circle";
        const double rx = length_of(node, circle ? "r" : "rx", circle ? v.diagonal() : v.width, 0.0);
        const double ry = circle ? rx : length_of(node, "ry", v.height, 0.0);
        if (!(rx > 0.0 && ry > 0.0)) return;
        pen.move_to({cx + rx, cy});
        for (const Vec2 p : {Vec2{cx, cy + ry}, Vec2{cx - rx, cy}, Vec2{cx, cy - ry}, Vec2{cx + rx, cy}}) pen.arc_to(rx, ry, 0.0, false, true, p);
        pen.close();
    }

    std::string_view text_;
    const DocumentOptions& options_;
    std::vector<Subpath>* guide_;
    bool guided_ = false;
    std::size_t uses_ = 0;
    pugi::xml_document xml_;
    StyleSheet sheet_;
    std::unordered_map<std::string, pugi::xml_node> ids_;
    Document out_;
    double tolerance_ = 0.0;
    std::vector<std::ptrdiff_t> line_ends_;
};

}  // namespace

void Notes::add(const std::string& what, const std::string& place) {
    const auto [it, fresh] = index_.try_emplace(what, entries_.size());
    if (fresh) entries_.push_back({what, place, 0});
    ++entries_[it->second].count;
}

std::vector<std::string> Notes::list() const {
    std::vector<std::string> out;
    for (const Entry& entry : entries_)
        out.push_back(entry.place + ": " + entry.what + (entry.count > 1 ? " (" + std::to_string(entry.count) + " times, this is the first)" : ""));
    return out;
}

const std::string* Names::find(const std::string& key) const {
    for (const Names* names = this; names != nullptr; names = names->outer.get())
        if (const auto found = names->data.find(key); found != names->data.end()) return &found->second;
    return nullptr;
}

Result<Document> read_document(std::string_view text, const DocumentOptions& options, std::vector<Subpath>* guide) {
    return Reader(text, options, guide).read();
}

}  // namespace burin::svg
