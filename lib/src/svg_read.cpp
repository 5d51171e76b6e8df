// read_svg: shapes of a drawing to strokes and regions, these to paths.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <tuple>

#include <burin/resolve.hpp>
#include <burin/svg.hpp>

#include "resolve_curve.hpp"
#include "svg_document.hpp"
#include "svg_meaning.hpp"
#include "svg_own.hpp"
#include "svg_regions.hpp"
#include "svg_strokes.hpp"
#include "svg_text.hpp"

namespace burin {
namespace svg {
namespace {

std::string exact_text(double value) {
    std::array<char, 32> text;
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

bool is_paint(const std::string& paint) { return !paint.empty() && paint != "none" && paint != "transparent"; }

bool is_seen(const Style& style, Property opacity) {
    for (const Property p : {opacity, Property::opacity}) {
        const auto value = parse_length(style[p], 1.0);
        if (value && *value <= 0.0) return false;
    }
    return true;
}

std::string color_of(const Style& style, Property paint, const char* usual) {
    const std::string& text = style[paint];
    if (text == "currentColor" || text == "currentcolor") return style[Property::color].empty() ? "#000000" : plain_color(style[Property::color]);
    return plain_color(text.empty() ? usual : text);
}

// Profiles of a pattern, each stored once. Beyond as many as a drawing has by hand, widths share profiles by scales.
class ProfileList {
  public:
    explicit ProfileList(Pattern& pattern) : pattern_(pattern) {}

    struct Section {
        std::uint32_t index = 0;
        double width = 0.0;              // of scale 1
        double lowest = 0.0, highest = 0.0;  // of the section, from the ground: material thrown up lies above it, beside a groove too
    };
    // Of a line that is `width` metres wide where it is widest.
    Result<Section> of_stroke(const Meaning& meaning, double width) {
        if (sections_.size() >= kMostWidths) width = std::exp2(std::ceil(std::log2(width)));
        const double height = (meaning.kind == Kind::groove ? -1.0 : 1.0) * (meaning.height > 0.0 ? meaning.height : 0.5 * width);
        const ProfileSpec spec = meaning.profile.value_or(ProfileSpec{});
        const auto key = std::tuple(spec.name, spec.parameters, width, height);
        if (const auto found = sections_.find(key); found != sections_.end()) return found->second;
        auto profile = make_profile(spec, width, height);
        if (!profile) return profile.error();
        Section section{0, width, 0.0, 0.0};
        for (const ProfilePoint& p : profile->points) section.lowest = std::min(section.lowest, p.h), section.highest = std::max(section.highest, p.h);
        section.index = add(std::move(*profile));
        sections_.emplace(key, section);
        return section;
    }

    Result<std::uint32_t> of_step(const Meaning& meaning, double rise) {
        const double width = meaning.width > 0.0 ? meaning.width : meaning.profile ? std::abs(rise) : 0.0;
        const ProfileSpec spec = meaning.profile.value_or(ProfileSpec{});
        const auto key = std::tuple(spec.name, spec.parameters, width, rise);
        if (const auto found = steps_.find(key); found != steps_.end()) return found->second;
        auto profile = make_step_profile(spec, width, rise);
        if (!profile) return profile.error();
        return steps_[key] = add(std::move(*profile));
    }

    // A stroke that runs along a step: its section, with the wall in the middle.
    std::uint32_t of_stroked_step(std::uint32_t stroke, double rise) {
        const auto key = std::pair(stroke, rise);
        if (const auto found = stroked_.find(key); found != stroked_.end()) return found->second;
        const Profile section = pattern_.profiles[stroke];
        Profile profile;
        bool risen = false;
        for (std::size_t i = 0; i < section.points.size(); ++i) {
            const ProfilePoint& p = section.points[i];
            if (!risen && p.b >= 0.0) {
                const ProfilePoint& q = section.points[i == 0 ? 0 : i - 1];
                const double share = p.b > q.b ? -q.b / (p.b - q.b) : 1.0, h = q.h + (p.h - q.h) * share;
                profile.points.push_back({0.0, h});
                profile.points.push_back({0.0, h + rise});
                risen = true;
                if (p.b == 0.0) continue;
            }
            profile.points.push_back({p.b, p.h + (risen ? rise : 0.0)});
        }
        return stroked_[key] = add(std::move(profile));
    }

  private:
    static constexpr std::size_t kMostWidths = 1024;
    std::uint32_t add(Profile profile) {
        pattern_.profiles.push_back(std::move(profile));
        return std::uint32_t(pattern_.profiles.size() - 1);
    }
    using Key = std::tuple<std::string, std::map<std::string, double>, double, double>;
    Pattern& pattern_;
    std::map<Key, Section> sections_;
    std::map<Key, std::uint32_t> steps_;
    std::map<std::pair<std::uint32_t, double>, std::uint32_t> stroked_;
};

// A curve whichever way it runs, to find strokes that lie on outlines.
using CurveKey = std::array<double, 6>;
CurveKey key_of(const Element& e) {
    const Vec2 control = e.kind == ElementKind::line ? lerp(e.p0, e.p2, 0.5) : e.p1;
    const bool forward = std::pair(e.p0.x, e.p0.y) <= std::pair(e.p2.x, e.p2.y);
    const Vec2 a = forward ? e.p0 : e.p2, b = forward ? e.p2 : e.p0;
    return {a.x, a.y, control.x, control.y, b.x, b.y};
}

class Drawing {
  public:
    Drawing(Document document, const SvgOptions& options, Meanings meanings)
        : document_(std::move(document)), options_(options), meanings_(std::move(meanings)), profiles_(out_.pattern) {}

    Result<SvgDrawing> make() {
        if (const Status begun = begin(); !begun) return begun.error();
        if (const Status read = read_shapes(); !read) return read.error();
        if (const Status stepped = add_steps(); !stepped) return stepped.error();
        for (std::size_t i = 0; i < strokes_.size(); ++i)
            if (const Status added = add_stroke(i); !added) return added.error();
        bound_heights();
        for (const std::string& one : meanings_.misread()) document_.notes.add(one, "layer or class");
        out_.notes = document_.notes.list();
        return std::move(out_);
    }

  private:
    Status begin() {
        Pattern& pattern = out_.pattern;
        if (document_.own) {
            auto root = read_own_root(document_);
            if (!root) return root.error();
            pattern = std::move(*root);
            own_high_ = pattern.base_offset, own_low_ = pattern.base_offset - pattern.depth;
        } else {
            pattern.size = document_.size;
            pattern.wrap = Wrap::clamp;
        }
        if (options_.wrap) pattern.wrap = *options_.wrap;
        tolerance_ = options_.tolerance > 0.0 ? options_.tolerance : 5e-5 * std::max(pattern.size.x, pattern.size.y);
        usual_step_ = std::min(pattern.size.x, pattern.size.y) / 200.0;
        return Done{};
    }

    // A drawing of white shapes alone is about these; among others white is paper.
    bool white_is_ground() {
        bool other = false;
        for (const Shape& shape : document_.shapes)
            other = other || (shape.fillable && !is_own(document_, shape) && is_paint(color_of(shape.style, Property::fill, "#000000")) &&
                              is_seen(shape.style, Property::fill_opacity) && color_of(shape.style, Property::fill, "#000000") != "#ffffff");
        return other;
    }

    // burin's own paths in the order of their numbers, whatever layers they lie in, so that an untouched drawing gives the same pattern.
    Status read_own() {
        std::vector<std::pair<std::size_t, const Shape*>> own;
        for (const Shape& shape : document_.shapes)
            if (is_own(document_, shape)) own.emplace_back(number_of(shape.names->id), &shape);
        std::stable_sort(own.begin(), own.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        for (const auto& [number, shape] : own) {
            if (const Status added = add_own_paths(*shape, out_.pattern, document_.notes); !added) return added;
            out_.sources.resize(out_.pattern.paths.size(), shape->place);
        }
        return Done{};
    }

    // N of path-N; behind all of these for other names.
    static std::size_t number_of(const std::string& id) {
        constexpr std::string_view kPrefix = "path-";
        std::size_t number = kNone;
        if (id.starts_with(kPrefix)) {
            const auto [end, error] = std::from_chars(id.data() + kPrefix.size(), id.data() + id.size(), number);
            if (error != std::errc{} || end != id.data() + id.size()) number = kNone;
        }
        return number;
    }

    Status read_shapes() {
        const bool paper = white_is_ground();
        if (const Status own = read_own(); !own) return own;
        for (std::size_t i = 0; i < document_.shapes.size(); ++i) {
            const Shape& shape = document_.shapes[i];
            if (is_own(document_, shape)) continue;
            if (document_.own && shape.names->data.contains("points")) continue;  // a profile that was made visible
            if (const Status filled = read_fill(i, paper); !filled) return filled;
            if (const Status stroked = read_stroke(i); !stroked) return stroked;
        }
        return Done{};
    }

    Status read_fill(std::size_t index, bool paper) {
        const Shape& shape = document_.shapes[index];
        const std::string color = color_of(shape.style, Property::fill, "#000000");
        if (!shape.fillable || !is_paint(color) || !is_seen(shape.style, Property::fill_opacity)) return Done{};
        auto meaning = meanings_.of(shape, true, color);
        if (!meaning) return meaning.error();
        if (paper && color == "#ffffff" && !meanings_.said(shape, true, color)) {
            document_.notes.add("white fill is taken as ground, since other fills are not white", shape.place);
            meaning->kind = Kind::ground;
        }
        if (meaning->kind == Kind::none) return Done{};
        Region region;
        region.outline = &shape.outline;
        region.even_odd = shape.style[Property::fill_rule] == "evenodd";
        const double height = meaning->height > 0.0 ? meaning->height : usual_step_;
        region.level = meaning->kind == Kind::plateau ? height : meaning->kind == Kind::sunken ? -height : 0.0;
        region.style = region_meanings_.size();
        regions_.push_back(region);
        region_meanings_.push_back(*meaning);
        region_shapes_.push_back(index);
        return Done{};
    }

    Status read_stroke(std::size_t index) {
        const Shape& shape = document_.shapes[index];
        const std::string color = color_of(shape.style, Property::stroke, "none");
        if (!is_paint(color) || !is_seen(shape.style, Property::stroke_opacity)) return Done{};
        const auto meaning = meanings_.of(shape, false, color);
        if (!meaning) return meaning.error();
        if (meaning->kind == Kind::none) return Done{};
        auto strokes = strokes_of(shape, *meaning, out_.pattern.size, document_.notes);
        if (!strokes) return strokes.error();
        for (Stroke& stroke : *strokes) {
            stroke.shape = index;
            strokes_.push_back(std::move(stroke));
        }
        return Done{};
    }

    // Part of a stroke's element that a step took over.
    struct Taken {
        double from, to;
    };
    struct StrokePlace {
        std::size_t stroke, element;
    };

    // Styles are merged where the edges would look the same, so that neighbours join.
    void merge_styles() {
        std::map<std::tuple<Kind, std::string, double, double>, std::size_t> same;
        for (Region& region : regions_) {
            const Meaning& m = region_meanings_[region.style];
            std::string profile = m.profile ? m.profile->name : "";
            if (m.profile)
                for (const auto& [name, value] : m.profile->parameters) profile += " " + name + std::to_string(value);
            region.style = same.try_emplace({m.kind, profile, m.height, m.width}, region.style).first->second;
        }
    }

    Status add_steps() {
        if (regions_.empty()) return Done{};
        merge_styles();
        for (std::size_t s = 0; s < strokes_.size(); ++s)
            if (!strokes_[s].dashed)
                for (std::size_t e = 0; e < strokes_[s].elements.size(); ++e) stroke_places_.emplace(key_of(strokes_[s].elements[e]), StrokePlace{s, e});
        for (const StepRun& run : trace_steps(regions_, {out_.pattern.size, 0.5 * tolerance_, options_.threads}))
            if (const Status added = add_run(run); !added) return added;
        return Done{};
    }

    // The stroke that lies on this piece of a step, if any.
    const StrokePlace* stroke_on(const StepSource& source) const {
        if (source.region == kNone || source.subpath == kNone) return nullptr;
        const Element& e = (*regions_[source.region].outline)[source.subpath].elements[source.element];
        const auto found = stroke_places_.find(key_of(e));
        return found == stroke_places_.end() ? nullptr : &found->second;
    }

    // Splits the run where strokes begin or end to lie on it; but into no piece so short that it would count as a dot
    // (ResolveOptions::snap) and leave its neighbours without an end.
    Status add_run(const StepRun& run) {
        const std::size_t n = run.elements.size();
        std::vector<const StrokePlace*> on;
        for (const StepSource& source : run.sources) on.push_back(stroke_on(source));
        std::vector<std::size_t> label(n);
        for (std::size_t i = 0; i < n; ++i) label[i] = on[i] == nullptr ? kNone : on[i]->stroke;
        absorb_short(run, label);
        std::size_t start = 0;
        if (run.closed)
            for (std::size_t i = 0; i < n; ++i)
                if (label[(i + n - 1) % n] != label[i]) start = i;
        for (std::size_t k = 0; k < n;) {
            std::size_t count = 1;
            while (k + count < n && label[(start + k) % n] == label[(start + k + count) % n]) ++count;
            const Span span{start + k, count, label[(start + k) % n], run.closed && count == n};
            if (const Status added = add_step_path(run, span, on); !added) return added;
            k += count;
        }
        return Done{};
    }

    // Stretches of one label that are too short take the label before them.
    void absorb_short(const StepRun& run, std::vector<std::size_t>& label) const {
        const double least = 4.0 * ResolveOptions{}.snap * std::max(out_.pattern.size.x, out_.pattern.size.y);
        const std::size_t n = label.size();
        for (std::size_t begin = 0; begin < n;) {
            std::size_t end = begin;
            double length_of = 0.0;
            while (end < n && label[end] == label[begin]) length_of += length(run.elements[end].p2 - run.elements[end].p0), ++end;
            const bool all = begin == 0 && end == n;
            if (!all && length_of < least) {
                const std::size_t other = begin > 0 ? label[begin - 1] : label[end % n];
                for (std::size_t i = begin; i < end; ++i) label[i] = other;
            }
            begin = end;
        }
    }

    // Elements of a run that make one path: how many from which on, and the stroke that lies on them.
    struct Span {
        std::size_t begin = 0, count = 0, stroke = kNone;
        bool closed = false;
    };

    Status add_step_path(const StepRun& run, const Span& span, const std::vector<const StrokePlace*>& on) {
        const std::size_t n = run.elements.size();
        Path path;
        path.closed = span.closed;
        path.level = run.left;
        const double rise = run.right - run.left;
        if (span.stroke == kNone) {
            const auto profile = profiles_.of_step(region_meanings_[run.style], rise);
            if (!profile) return profile.error();
            path.profile = *profile;
        } else {
            const Stroke& stroke = strokes_[span.stroke];
            const auto section = section_of(stroke);
            if (!section) return section.error();
            path.profile = profiles_.of_stroked_step(section->index, rise);
            path.join = stroke.join;
            note_heights(*section, 1.0);
        }
        for (std::size_t k = 0; k < span.count; ++k) {
            const std::size_t i = (span.begin + k) % n;
            Element e = run.elements[i];
            if (on[i] != nullptr && on[i]->stroke == span.stroke) take_over(*on[i], run.sources[i], e);
            path.elements.push_back(e);
        }
        level_low_ = std::min({level_low_, run.left, run.right}), level_high_ = std::max({level_high_, run.left, run.right});
        // An edge may throw material up beyond both levels.
        if (span.stroke == kNone)
            for (const ProfilePoint& p : out_.pattern.profiles[path.profile].points)
                level_low_ = std::min(level_low_, run.left + p.h), level_high_ = std::max(level_high_, run.left + p.h);
        const std::size_t region = run.sources[span.begin % n].region;
        add_path(std::move(path), region == kNone ? "" : document_.shapes[region_shapes_[region]].place);
        return Done{};
    }

    // The step's piece gets the stroke's width, and the stroke loses the piece.
    void take_over(const StrokePlace& place, const StepSource& source, Element& e) {
        const Stroke& stroke = strokes_[place.stroke];
        const Element& line = stroke.elements[place.element];
        const Element& outline = (*regions_[source.region].outline)[source.subpath].elements[source.element];
        const bool along = line.p0 == outline.p0;
        const auto on_stroke = [&](double t) { return along ? t : 1.0 - t; };
        const double from = on_stroke(source.from), to = on_stroke(source.to), width = widest(stroke);
        e.width0 = (line.width0 + (line.width1 - line.width0) * from) / width;
        e.width1 = (line.width0 + (line.width1 - line.width0) * to) / width;
        taken_[{place.stroke, place.element}].push_back({std::min(from, to), std::max(from, to)});
    }

    static double widest(const Stroke& stroke) {
        double width = 0.0;
        for (const Element& e : stroke.elements) width = std::max({width, e.width0, e.width1});
        return width;
    }

    Result<ProfileList::Section> section_of(const Stroke& stroke) {
        auto section = profiles_.of_stroke(stroke.meaning, widest(stroke));
        if (!section) return Error{section.error().code, document_.shapes[stroke.shape].place + ": " + section.error().message};
        return section;
    }

    // What is left of a stroke: as a whole where no step took a piece.
    Status add_stroke(std::size_t index) {
        Stroke& stroke = strokes_[index];
        std::vector<std::vector<Element>> runs(1);
        bool cut = false;
        for (std::size_t i = 0; i < stroke.elements.size(); ++i) {
            const auto found = taken_.find({index, i});
            if (found == taken_.end()) {
                runs.back().push_back(stroke.elements[i]);
                continue;
            }
            cut = true;
            std::sort(found->second.begin(), found->second.end(), [](const Taken& a, const Taken& b) { return a.from < b.from; });
            double at = 0.0;
            for (const Taken& taken : found->second) {
                if (taken.from - at > 1e-6) runs.back().push_back(curve::part(stroke.elements[i], at, taken.from));
                if (!runs.back().empty()) runs.emplace_back();
                at = std::max(at, taken.to);
            }
            if (1.0 - at > 1e-6) runs.back().push_back(curve::part(stroke.elements[i], at, 1.0));
        }
        if (runs.back().empty()) runs.pop_back();
        // A closed line that was cut goes on from its end to its start.
        if (cut && stroke.closed && runs.size() > 1 && runs.back().back().p2 == runs.front().front().p0) {
            runs.back().insert(runs.back().end(), runs.front().begin(), runs.front().end());
            runs.erase(runs.begin());
        }
        for (std::vector<Element>& run : runs) {
            Stroke piece = stroke;
            piece.elements = std::move(run);
            piece.closed = stroke.closed && !cut;
            if (const Status added = add_line(std::move(piece)); !added) return added;
        }
        return Done{};
    }

    Status add_line(Stroke stroke) {
        add_square_caps(stroke);
        const double width = widest(stroke);
        if (!(width > 0.0)) return Done{};
        const auto section = section_of(stroke);
        if (!section) return section.error();
        Path path;
        path.profile = section->index;
        path.closed = stroke.closed;
        path.join = stroke.join;
        path.start_cap = path.end_cap = stroke.cap;
        path.elements = std::move(stroke.elements);
        // With the usual height a narrower part is as much lower.
        const bool even = stroke.meaning.height > 0.0;
        double highest = 0.0;
        for (Element& e : path.elements) {
            e.width0 /= section->width, e.width1 /= section->width;
            if (!even) e.height0 = e.width0, e.height1 = e.width1;
            highest = std::max({highest, e.height0, e.height1});
        }
        note_heights(*section, highest);
        add_path(std::move(path), document_.shapes[stroke.shape].place);
        return Done{};
    }

    void note_heights(const ProfileList::Section& section, double scale) {
        groove_ = std::min(groove_, section.lowest * scale), ridge_ = std::max(ridge_, section.highest * scale);
    }

    // Specks that nobody sees are left out: slivers where outlines nearly coincide.
    void add_path(Path path, const std::string& place) {
        const double speck = 2e-6 * std::max(out_.pattern.size.x, out_.pattern.size.y);
        const auto is_short = [&](const Element& e) { return length(e.p2 - e.p0) < speck && length(e.p1 - e.p0) < speck; };
        if (std::all_of(path.elements.begin(), path.elements.end(), is_short)) return;
        out_.pattern.paths.push_back(std::move(path));
        out_.sources.push_back(place);
    }

    // The object surface touches what is highest: the highest section as if it stood on the highest level.
    void bound_heights() {
        Pattern& pattern = out_.pattern;
        const double high = std::max(own_high_, level_high_ + ridge_), low = std::min(own_low_, level_low_ + groove_);
        if (document_.own && high == own_high_ && low == own_low_) return;
        pattern.base_offset = high;
        pattern.depth = high - low;
        // Nothing is drawn: any depth will do.
        if (!(pattern.depth > 0.0)) pattern.depth = usual_step_;
    }

    Document document_;
    const SvgOptions& options_;
    Meanings meanings_;
    SvgDrawing out_;
    ProfileList profiles_;
    double tolerance_ = 0.0, usual_step_ = 0.0;
    double own_high_ = 0.0, own_low_ = 0.0, level_low_ = 0.0, level_high_ = 0.0, groove_ = 0.0, ridge_ = 0.0;
    std::vector<Region> regions_;
    std::vector<Meaning> region_meanings_;
    std::vector<std::size_t> region_shapes_;
    std::vector<Stroke> strokes_;
    std::map<CurveKey, StrokePlace> stroke_places_;
    std::map<std::pair<std::size_t, std::size_t>, std::vector<Taken>> taken_;
};

// As one more shape of the drawing, on top of the others.
Status add_text(const SvgOptions& options, const std::vector<Subpath>& guide, Document& document) {
    const double side = std::max(document.size.x, document.size.y);
    auto lines = lay_text(options.text, guide, document.size, options.tolerance > 0.0 ? options.tolerance : 5e-5 * side);
    if (!lines) return lines.error();
    const double size = options.text.size > 0.0 ? options.text.size : 0.1 * std::min(document.size.x, document.size.y);
    Shape shape;
    shape.place = "text '" + options.text.words + "'";
    shape.names = std::make_shared<Names>();
    shape.outline = std::move(*lines);
    shape.fillable = false;
    shape.style[Property::stroke] = "#000000";
    shape.style[Property::stroke_linecap] = shape.style[Property::stroke_linejoin] = "round";
    shape.style[Property::stroke_width] = exact_text(options.text.width > 0.0 ? options.text.width : size / 12.0);
    document.shapes.push_back(std::move(shape));
    return Done{};
}

}  // namespace
}  // namespace svg

Result<SvgDrawing> read_svg(std::string_view text, const SvgOptions& options) {
    const auto meanings = svg::Meanings::read(options);
    if (!meanings) return meanings.error();
    svg::DocumentOptions document_options;
    document_options.width = options.width, document_options.height = options.height;
    document_options.tolerance = options.tolerance;
    document_options.text_path = options.text.path;
    std::vector<Subpath> guide;
    auto document = svg::read_document(text, document_options, &guide);
    if (!document) return document.error();
    if (!options.text.words.empty())
        if (const Status added = svg::add_text(options, guide, *document); !added) return added.error();
    return svg::Drawing(std::move(*document), options, *meanings).make();
}

}  // namespace burin
