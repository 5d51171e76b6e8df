#include "svg_strokes.hpp"

#include <algorithm>
#include <cmath>

#include "resolve_curve.hpp"

namespace burin::svg {
namespace {

// How wide a stroke of one user unit is across a line that runs along `along` in pattern space: a circle becomes an ellipse.
double width_across(const Affine& m, Vec2 along) {
    const double det = m.determinant();
    if (det == 0.0) return 0.0;
    const Vec2 t = unit(along);
    const Vec2 before{(m.d * t.x - m.c * t.y) / det, (m.a * t.y - m.b * t.x) / det};
    return std::abs(det) * length(before);
}

Result<std::vector<double>> dashes_of(const Shape& shape, double scale) {
    const std::string& text = shape.style[Property::stroke_dasharray];
    std::vector<double> dashes;
    if (text.empty() || text == "none") return dashes;
    std::string blanks = text;
    std::replace(blanks.begin(), blanks.end(), ',', ' ');
    double sum = 0.0;
    for (const std::string& word : split_words(blanks)) {
        const auto length = parse_length(word, 0.0);
        if (!length || *length < 0.0) return Error{ErrorCode::invalid_input, shape.place + ": stroke-dasharray '" + text + "' is no list of lengths"};
        dashes.push_back(*length * scale);
        sum += dashes.back();
    }
    if (sum == 0.0) dashes.clear();
    if (dashes.size() % 2 == 1) dashes.insert(dashes.end(), dashes.begin(), dashes.begin() + std::ptrdiff_t(dashes.size()));
    return dashes;
}

// The part of a chain between two arc lengths.
std::vector<Element> cut_out(const std::vector<Element>& elements, const std::vector<double>& ends, double from, double to) {
    std::vector<Element> out;
    double begin = 0.0;
    for (std::size_t i = 0; i < elements.size(); begin = ends[i++]) {
        const double low = std::max(from, begin), high = std::min(to, ends[i]);
        if (!(high > low)) continue;
        const double span = ends[i] - begin;
        // Parameter at an arc length, by halving: dashes need no more than a few digits.
        const auto at = [&](double s) {
            if (s <= begin) return 0.0;
            if (s >= ends[i]) return 1.0;
            if (elements[i].kind == ElementKind::line) return (s - begin) / span;
            double a = 0.0, b = 1.0;
            for (int k = 0; k < 40; ++k) {
                const double middle = 0.5 * (a + b);
                (curve::arc_length(curve::part(elements[i], 0.0, middle)) < s - begin ? a : b) = middle;
            }
            return 0.5 * (a + b);
        };
        out.push_back(curve::part(elements[i], at(low), at(high)));
        if (out.size() > 1) out.back().p0 = out[out.size() - 2].p2;
    }
    return out;
}

// Dashes of a line; each is one of its own.
Status add_dashes(const Stroke& whole, const std::vector<double>& dashes, double offset, const std::string& place, std::vector<Stroke>& out) {
    std::vector<double> ends;
    for (const Element& e : whole.elements) ends.push_back((ends.empty() ? 0.0 : ends.back()) + curve::arc_length(e));
    double sum = 0.0;
    for (const double dash : dashes) sum += dash;
    double at = -std::fmod(offset, sum);
    if (at > 0.0) at -= sum;
    if (ends.back() / sum * double(dashes.size()) > double(kMaxDashes))
        return Error{ErrorCode::limit_exceeded, place + ": more than " + std::to_string(kMaxDashes) + " dashes; a longer stroke-dasharray works"};
    for (std::size_t k = 0; at < ends.back(); at += dashes[k], k = (k + 1) % dashes.size()) {
        if (k % 2 == 1 || at + dashes[k] <= 0.0) continue;
        Stroke dash = whole;
        dash.closed = false;
        dash.dashed = true;
        dash.elements = cut_out(whole.elements, ends, at, std::min(at + dashes[k], ends.back()));
        if (!dash.elements.empty()) out.push_back(std::move(dash));
    }
    return Done{};
}

// A dot: as SVG shows a line without length that has round or square caps.
void add_dot(const Subpath& subpath, double width, Vec2 size, Stroke stroke, std::vector<Stroke>& out) {
    if (stroke.cap == CapKind::butt && !stroke.square) return;
    Element e;
    // Shorter than what counts as an open path that meets others (ResolveOptions::snap).
    const double half = stroke.square ? 0.5 * width : 2e-5 * std::max(size.x, size.y);
    stroke.square = false;
    e.p0 = subpath.start - Vec2{half, 0.0}, e.p2 = subpath.start + Vec2{half, 0.0}, e.p1 = subpath.start;
    e.width0 = e.width1 = width;
    stroke.elements = {e};
    stroke.closed = false;
    out.push_back(std::move(stroke));
}

}  // namespace

Result<std::vector<Stroke>> strokes_of(const Shape& shape, const Meaning& meaning, Vec2 size, Notes& notes) {
    const double scale = scale_of(shape.to_pattern);
    const std::string& text = shape.style[Property::stroke_width];
    const auto width = text.empty() ? std::optional(1.0) : parse_length(text, size.x / std::max(scale, 1e-300));
    if (!width || *width < 0.0) return Error{ErrorCode::invalid_input, shape.place + ": stroke-width '" + text + "' is no length"};
    std::vector<Stroke> out;
    if (*width == 0.0 && meaning.width == 0.0) return out;
    const auto dashes = dashes_of(shape, scale);
    if (!dashes) return dashes.error();
    const double offset = parse_length(shape.style[Property::stroke_dashoffset], 0.0).value_or(0.0) * scale;
    const std::string &join = shape.style[Property::stroke_linejoin], &cap = shape.style[Property::stroke_linecap];
    Stroke base;
    base.meaning = meaning;
    base.join = join == "round" ? JoinKind::round : join == "bevel" ? JoinKind::bevel : JoinKind::mitre;
    base.cap = cap == "round" ? CapKind::round : CapKind::butt;
    base.square = cap == "square";
    const std::string& limit = shape.style[Property::stroke_miterlimit];
    if (base.join == JoinKind::mitre && !limit.empty() && parse_length(limit, 0.0).value_or(4.0) <= 1.0) base.join = JoinKind::bevel;
    else if (base.join == JoinKind::mitre && !limit.empty() && std::abs(parse_length(limit, 0.0).value_or(4.0) - 4.0) > 1e-6)
        notes.add("stroke-miterlimit " + limit + " is taken as 4, the limit of the format", shape.place);
    for (const Subpath& subpath : shape.outline) {
        if (subpath.elements.empty()) {
            add_dot(subpath, meaning.width > 0.0 ? meaning.width : *width * scale, size, base, out);
            continue;
        }
        Stroke stroke = base;
        stroke.closed = subpath.closed;
        stroke.elements = subpath.elements;
        for (Element& e : stroke.elements) {
            e.width0 = meaning.width > 0.0 ? meaning.width : *width * width_across(shape.to_pattern, curve::tangent(e, 0.0));
            e.width1 = meaning.width > 0.0 ? meaning.width : *width * width_across(shape.to_pattern, curve::tangent(e, 1.0));
        }
        if (dashes->empty()) out.push_back(std::move(stroke));
        else if (const Status added = add_dashes(stroke, *dashes, offset, shape.place, out); !added) return added.error();
    }
    return out;
}

void add_square_caps(Stroke& stroke) {
    if (!stroke.square || stroke.closed || stroke.elements.empty()) return;
    stroke.square = false;
    const auto extend = [&](bool at_start) {
        const Element& e = at_start ? stroke.elements.front() : stroke.elements.back();
        const double width = at_start ? e.width0 : e.width1;
        const Vec2 end = at_start ? e.p0 : e.p2, along = at_start ? -curve::tangent(e, 0.0) : curve::tangent(e, 1.0);
        const Vec2 far = end + along * (0.5 * width);
        Element more;
        more.p0 = at_start ? far : end, more.p2 = at_start ? end : far;
        more.p1 = lerp(more.p0, more.p2, 0.5);
        more.width0 = more.width1 = width;
        stroke.elements.insert(at_start ? stroke.elements.begin() : stroke.elements.end(), more);
    };
    extend(true);
    extend(false);
}

}  // namespace burin::svg
