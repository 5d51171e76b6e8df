#include "areas.hpp"

#include <algorithm>
#include <cmath>

#include <burin/evaluate.hpp>

namespace burin::reference {
namespace {

constexpr int kMostHalvings = 16;

double width_of(const AreasOptions& options, double area) { return options.width > 0.0 ? options.width : std::sqrt(area); }

double reach_of(const Region& region) { return std::max(region.box.high.x - region.box.low.x, region.box.high.y - region.box.low.y); }

// Heights and places nearer than this are equal.
double fine_of(const GroovedSurface& surface, const Region& region) { return 1e-9 * std::max(reach_of(region), surface.pattern().depth); }

// What hides and shades comes from afar where view or light are low: it may be coarser there.
double tolerance_in(const Region& region, const AreasOptions& options, double area) {
    return options.tolerance * std::max(width_of(options, area), 0.02 * reach_of(region));
}

// Asks the blocks for what was gathered. Requires: request.fine.
void sample_gathered(const GroovedSurface& surface, const AreasOptions& options, double area, AreaRequest& request, AreasWork& work, std::vector<Share>& out) {
    const Region& region = work.gathered.region;
    request.lowest = work.gathered.lowest - request.fine, request.highest = work.gathered.highest + request.fine;
    work.blocks.choose(surface, width_of(options, area), reach_of(region), tolerance_in(region, options, area));
    sample_areas(work.blocks, request, work.area, out);
}

class Finder {
  public:
    Finder(const GroovedSurface& surface, const Slopes& slopes, const AreasOptions& options, double whole, AreasWork& work, std::vector<Share>& out,
           bool within = false)
        : surface_(surface), slopes_(slopes), options_(options), whole_(whole), work_(work), out_(out), within_(within) {}

    void find(const Footprint& footprint, int halvings) {
        gather(footprint);
        const double tolerance = tolerance_in(work_.gathered.region, options_, area_of(footprint));
        if (!options_.corners && work_.gathered.instances.empty() && is_inside_map(surface_, work_.gathered.region)) return find_plain(footprint);
        if (options_.lines && !options_.corners && sample_lines(surface_, work_.gathered, footprint, slopes_, tolerance, whole_, work_.line, out_)) {
            ++work_.by_line;
            return;
        }
        if (halvings < kMostHalvings && is_worth_halving(footprint)) {
            Footprint first, second;
            halve(footprint, first, second);
            find(first, halvings + 1);
            find(second, halvings + 1);
            return;
        }
        ++work_.by_area;
        AreaRequest request;
        request.footprint = &footprint;
        request.direction = {slopes_.view, surface_.top(), within_};
        request.within = within_;
        request.slopes = slopes_;
        request.whole = whole_;
        request.corners = options_.corners;
        request.fine = fine_of(surface_, work_.gathered.region);
        sample_gathered(surface_, options_, area_of(footprint), request, work_, out_);
    }

  private:
    void gather(const Footprint& footprint) {
        if (!within_) return gather_grooves(surface_, footprint, slopes_, work_.gathered);
        Footprint below;
        for (const Vec2 p : footprint.corners) below.corners.push_back(p + slopes_.view * (surface_.top() - surface_.lowest()));
        gather_grooves(surface_, below, slopes_, {surface_.lowest(), surface_.lowest(), true, true}, work_.gathered);
    }
    // Many elements, and fewer of them near a half: not where what matters is long for the sake of low view or light.
    bool is_worth_halving(const Footprint& footprint) const {
        if (static_cast<int>(work_.gathered.instances.size()) <= options_.most_elements) return false;
        const Box own = box_of(footprint), &all = work_.gathered.region.box;
        return std::max(own.high.x - own.low.x, own.high.y - own.low.y) > 0.4 * std::max(all.high.x - all.low.x, all.high.y - all.low.y);
    }
    void find_plain(const Footprint& footprint) {
        const Vec2 middle = middle_of(footprint);
        const double level = ground_near(surface_, lerp(work_.gathered.region.box.low, work_.gathered.region.box.high, 0.5));
        Share share;
        share.element = share.facet = kGround;
        share.normal = {0, 0, 1};
        share.seen = area_of(footprint) / whole_;
        share.lit = slopes_.lit ? share.seen : 0.0;
        const Vec2 at = middle + slopes_.view * (surface_.top() - level);
        share.place = {at.x, at.y, level};
        out_.push_back(share);
    }

    const GroovedSurface& surface_;
    const Slopes& slopes_;
    const AreasOptions& options_;
    double whole_;
    AreasWork& work_;
    std::vector<Share>& out_;
    bool within_;
};

// Edges as short as rounding bound nothing. False: nothing is left that has an area.
bool drop_short_edges(Footprint& footprint, double thin) {
    const double least = 64.0 * thin;
    std::vector<Vec2> kept;
    for (const Vec2 p : footprint.corners)
        if (kept.empty() || (length(p - kept.back()) > least && length(p - kept.front()) > least)) kept.push_back(p);
    footprint.corners.swap(kept);
    const Box box = box_of(footprint);
    return footprint.corners.size() > 2 && area_of(footprint) > least * std::max(box.high.x - box.low.x, box.high.y - box.low.y);
}

}  // namespace

void find_areas(const GroovedSurface& surface, const Footprint& footprint, const Slopes& slopes, const AreasOptions& options, AreasWork& work,
                std::vector<Share>& out) {
    out.clear();
    work.area.corners.clear();
    Finder(surface, slopes, options, area_of(footprint), work, out).find(footprint, 0);
}

void find_areas_within(const GroovedSurface& surface, const Footprint& footprint, Vec2 slope, const AreasOptions& options, AreasWork& work,
                       std::vector<Share>& out) {
    out.clear();
    work.area.corners.clear();
    AreasOptions own = options;
    own.corners = true;
    Finder(surface, {slope, {0, 0}, false}, own, area_of(footprint), work, out, true).find(footprint, 0);
}

double find_hits(const GroovedSurface& surface, const Beam& beam, const Slopes& slopes, const AreasOptions& options, AreasWork& work,
                 std::vector<Share>& out) {
    out.clear();
    work.area.corners.clear();
    const Vec3 d = beam.direction;
    Start start{1e300, -1e300, d.z > 0.0, beam.within};
    AreaRequest request;
    request.direction = {Vec2{-d.x / d.z, -d.y / d.z}, surface.top(), start.rising};
    request.slopes = slopes;
    request.slopes.view = request.direction.slope;
    request.slopes.lit = slopes.lit && !beam.within;
    request.within = beam.within;
    request.corners = request.leaves = true;
    Footprint plan_of, shown;
    for (const Vec3 p : beam.corners) {
        start.low = std::min(start.low, p.z);
        start.high = std::max(start.high, p.z);
        plan_of.corners.push_back(plan(p));
        shown.corners.push_back(request.direction.show(p));
    }
    if (area_of(shown) < 0.0) std::reverse(shown.corners.begin(), shown.corners.end());
    request.whole = area_of(shown);
    if (!(request.whole > 0.0)) return 1.0;
    gather_grooves(surface, plan_of, request.slopes, start, work.gathered);
    if (start.rising ? start.low >= work.gathered.highest : start.high <= work.gathered.lowest) return 1.0;
    const double met_area = request.whole;
    request.fine = fine_of(surface, work.gathered.region);
    if (!drop_short_edges(shown, 0.25 * request.fine)) return 1.0;
    request.whole = area_of(shown);
    request.footprint = &shown;
    request.normal = beam.normal;
    request.corner = beam.corners[0];
    sample_gathered(surface, options, met_area, request, work, out);
    double met = 0.0;
    for (const Share& share : out) met += share.seen;
    return std::max(0.0, 1.0 - met);
}

}  // namespace burin::reference
