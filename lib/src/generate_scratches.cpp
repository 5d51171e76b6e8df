// Scratches and what is like them: many short grooves that know nothing of each other.
#include <algorithm>
#include <cmath>

#include "generate_internal.hpp"
#include "parallel.hpp"

namespace burin::generating {
namespace {

constexpr double kMost = 4e6;
constexpr std::size_t kPerPiece = 4096;
constexpr double kGreatestScale = 3.9;   // scales of an element stay below 4
constexpr double kStraight = 1.0;        // degrees: what turns less is a line
constexpr double kGreatestTurn = 150.0;  // degrees, along one scratch

// Streams of chance: pieces count from 0, clusters from here.
constexpr std::uint64_t kClusters = 1ull << 40;

// What the scratches of one cluster share: where it lies, and the way that something was dragged over the surface.
struct Cluster {
    Vec2 centre;
    double direction = 0.0;  // degrees
    double length = 1.0;     // factor
};

class Scratcher {
  public:
    Scratcher(const Work& work, std::uint32_t profile)
        : work_(work), profile_(profile), direction_(work.value("direction")), spread_(work.value("spread")), length_(work.value("length")),
          length_spread_(work.value("length_spread")), bend_(work.value("bend")), width_spread_(work.value("width_spread")),
          depth_spread_(work.value("depth_spread")), taper_(work.value("taper")), cluster_size_(work.value("cluster_size")),
          radius_(work.value("cluster_radius")) {}

    // One scratch, where the mask lets it be.
    void add(std::vector<Path>& paths, Chance& chance, std::uint64_t index, bool clustered) const {
        const Cluster at = clustered ? near(cluster(index / std::uint64_t(cluster_size_)), chance) : cluster_at(chance);
        const double length = length_ * at.length * chance.around_one(clustered ? 0.3 * length_spread_ : 0.0);
        const double turn = std::clamp(bend_ * chance.normal(), -kGreatestTurn, kGreatestTurn);
        const double width = std::min(kGreatestScale, chance.around_one(width_spread_));
        const double depth = std::min(kGreatestScale, chance.around_one(depth_spread_));
        const double peak = chance.between(0.2, 0.8), worn = chance.uniform();
        if (worn < work_.worn_at(at.centre)) paths.push_back(drawn(at, length, turn, peak, width, depth));
    }

  private:
    Cluster cluster_at(Chance& chance) const {
        const Vec2 size = work_.pattern.size;
        Cluster at;
        at.centre.x = size.x * chance.uniform();
        at.centre.y = size.y * chance.uniform();
        at.direction = direction_ + spread_ * chance.normal();
        at.length = chance.around_one(length_spread_);
        return at;
    }

    Cluster cluster(std::uint64_t number) const {
        Chance chance(work_.spec.seed, kClusters + number);
        return cluster_at(chance);
    }

    // Close to the cluster's own, and nearly parallel.
    Cluster near(Cluster at, Chance& chance) const {
        at.centre.x += radius_ * chance.normal();
        at.centre.y += radius_ * chance.normal();
        at.direction += 4.0 * chance.normal();
        return at;
    }

    // Along an arc that turns by `turn` degrees, deepest at the share `peak` of its parameter.
    Path drawn(const Cluster& at, double length, double turn, double peak, double width, double depth) const {
        const Vec2 way = steady::direction(at.direction / kFullTurn), half = steady::direction(0.5 * turn / kFullTurn);
        const double angle = 0.5 * turn / kFullTurn * 6.283185307179586;  // radians, half of the turn
        const bool curved = std::abs(turn) >= kStraight;
        const Vec2 reach = way * (0.5 * length * (curved ? half.y / angle : 1.0));
        const Vec2 from = at.centre - reach, to = at.centre + reach;
        // Tangents at both ends meet over the middle of the chord.
        const Vec2 control = at.centre + normal_of(reach) * (half.y / half.x);
        Path path;
        path.profile = profile_;
        path.elements = {curved ? bent(from, control, to) : straight(from, to)};
        if (taper_ > 0.0) path.elements = split(path.elements.front(), peak);
        const double ends[] = {1.0 - taper_, 1.0, 1.0 - taper_};
        for (std::size_t i = 0; i < path.elements.size(); ++i) {
            const double first = taper_ > 0.0 ? ends[i] : 1.0, last = taper_ > 0.0 ? ends[i + 1] : 1.0;
            Element& e = path.elements[i];
            e.width0 = width * first, e.width1 = width * last;
            e.height0 = depth * first, e.height1 = depth * last;
        }
        return path;
    }

    static std::vector<Element> split(const Element& e, double s) {
        if (e.kind == ElementKind::line) {
            const Vec2 middle = lerp(e.p0, e.p2, s);
            return {straight(e.p0, middle), straight(middle, e.p2)};
        }
        const Vec2 before = lerp(e.p0, e.p1, s), after = lerp(e.p1, e.p2, s), middle = lerp(before, after, s);
        return {bent(e.p0, before, middle), bent(middle, after, e.p2)};
    }

    const Work& work_;
    std::uint32_t profile_;
    double direction_, spread_, length_, length_spread_, bend_, width_spread_, depth_spread_, taper_, cluster_size_, radius_;
};

}  // namespace

Status make_scratches(Work& work) {
    const double wanted = std::round(work.value("density") * work.area() * 1e4);
    if (wanted > kMost)
        return refuse(work, "density " + parameter_text(work.value("density")) + " gives " + parameter_text(wanted) + " paths on " +
                                parameter_text(work.area() * 1e4) + " square centimetres; 4000000 at most, so " +
                                parameter_text(std::floor(kMost / (work.area() * 1e4))) + " works");
    const auto profile = work.add_section(work.value("width"), -work.value("depth"));
    if (!profile) return profile.error();
    const std::size_t count = std::size_t(wanted), clustered = std::size_t(wanted * work.value("clustered"));
    const Scratcher scratcher(work, *profile);
    std::vector<std::vector<Path>> pieces((count + kPerPiece - 1) / kPerPiece);
    for_each_piece(pieces.size(), work.spec.threads, [&](std::size_t piece) {
        Chance chance(work.spec.seed, piece);
        const std::size_t begin = piece * kPerPiece, end = std::min(count, begin + kPerPiece);
        pieces[piece].reserve(end - begin);
        for (std::size_t i = begin; i < end; ++i) scratcher.add(pieces[piece], chance, i, i < clustered);
    });
    work.pattern.paths.reserve(count);
    for (std::vector<Path>& piece : pieces) std::move(piece.begin(), piece.end(), std::back_inserter(work.pattern.paths));
    return Done{};
}

}  // namespace burin::generating
