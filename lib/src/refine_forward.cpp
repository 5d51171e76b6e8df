#include "refine_forward.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <thread>
#include <unordered_map>

#include "refine_scene.hpp"

namespace burin::refinement {
namespace {

constexpr int kRowsPerPart = 4;      // tile rows that are summed together, whatever the number of threads
constexpr double kStraight = 0.004;  // curvature per texel below which an arc is integrated like a line
constexpr int kProbes = 4;           // per side: whether a texel needs more cells
constexpr double kFlat = 1e-7;       // derivative by place, per texel, that counts as none

struct Candidate {
    std::uint32_t instance = 0;
    const Feature* feature = nullptr;
    Vec2 offset;
    Foot foot;  // of the texel's centre
    Reach reach;
    bool used = false;
    std::array<double, kMaxLocal> local;  // derivatives of the texel's mean; valid when used
};

// One feature's say in one cell.
struct Say {
    Placement placement;
    Spread spread;
    double value = 0.0;
    bool cuts = false;
};

double scale_at(double start, double end, double along) { return start + (end - start) * along; }

Spread spread_of(const Placement& placement, Vec2 cell, double width) {
    return {std::max(1e-9, std::abs(placement.gradient.x) * cell.x / width),
            std::max(1e-9, std::abs(placement.gradient.y) * cell.y / width)};
}

int local_count(const Feature& feature) { return kProfile + 2 * static_cast<int>(feature.profile->b.size()); }

void start_using(Candidate& candidate) {
    if (candidate.used) return;
    candidate.used = true;
    std::fill_n(candidate.local.begin(), local_count(*candidate.feature), 0.0);
}

class TexelModel {
  public:
    TexelModel(const Layout& layout, int divisions, bool derivatives)
        : layout_(layout), divisions_(divisions), derivatives_(derivatives) {}

    // Gathers what may act near texel (x, y). False when nothing is near.
    bool gather(int x, int y) {
        tile_ = static_cast<std::size_t>(y / kTile) * layout_.tile_columns + static_cast<std::size_t>(x / kTile);
        const std::uint32_t first = layout_.first[tile_], last = layout_.first[tile_ + 1];
        count_ = 0;
        acting_ = 0;
        if (first == last) return false;
        centre_ = layout_.centre(x, y);
        near_step_ = false;
        ground_ = layout_.outer_level;
        if (!layout_.ground.empty()) {
            const float level = layout_.ground[static_cast<std::size_t>(y) * layout_.width + x];
            near_step_ = level == kNearStep;
            ground_ = level;
        }
        if (candidates_.size() < last - first) candidates_.resize(last - first);
        for (std::uint32_t k = first; k < last; ++k) consider(layout_.listed[k]);
        return count_ > 0;
    }

    // Mean of the model over the texel; with derivatives in the candidates that shape it.
    double mean() {
        int divisions = cells_per_side();
        if (divisions > kProbes && ruled_by_one()) divisions = kProbes;
        const Vec2 cell = layout_.side * (1.0 / divisions);
        const double share = 1.0 / (divisions * divisions);
        const Vec2 corner = centre_ - layout_.side * 0.5;
        double sum = 0.0;
        for (int j = 0; j < divisions; ++j)
            for (int i = 0; i < divisions; ++i)
                sum += cell_mean({corner.x + (i + 0.5) * cell.x, corner.y + (j + 0.5) * cell.y}, cell, share, derivatives_);
        return sum * share;
    }

    std::size_t count() const { return count_; }
    Candidate& candidate(std::size_t i) { return candidates_[i]; }

  private:
    void consider(std::uint32_t index) {
        const Instance& instance = layout_.instances[index];
        const Feature& feature = layout_.features[instance.element];
        Candidate& c = candidates_[count_];
        const Vec2 p = centre_ - instance.offset;
        c.foot = foot_of(feature.frame, p);
        const double half = layout_.half_diagonal();
        if (!reach_at(feature.frame, p, c.foot, feature.left, feature.right, half + kNearMargin).possible) return;
        c.reach = reach_at(feature.frame, p, c.foot, feature.left, feature.right, half);
        c.instance = index;
        c.feature = &feature;
        c.offset = instance.offset;
        c.used = false;
        ++count_;
        if (c.reach.possible) ++acting_;
    }

    int cells_per_side() const {
        if (acting_ == 0 && !near_step_) return 1;
        if (acting_ > 1) return joined_smoothly() ? std::min(4, divisions_) : divisions_;
        for (std::size_t i = 0; i < count_; ++i) {
            const Candidate& c = candidates_[i];
            if (!c.reach.possible) continue;
            if (!c.reach.plain) return divisions_;
            return std::abs(c.foot.bend) <= kStraight ? 1 : std::abs(c.foot.bend) < 0.05 ? 2 : 4;
        }
        return 1;
    }

    // Whether one feature, or the ground, rules wherever it is asked in the texel, though several might.
    bool ruled_by_one() {
        const Vec2 cell = layout_.side * (1.0 / kProbes);
        const Vec2 corner = centre_ - layout_.side * 0.5;
        int winner = -2;
        for (int j = 0; j < kProbes; ++j) {
            for (int i = 0; i < kProbes; ++i) {
                cell_mean({corner.x + (i + 0.5) * cell.x, corner.y + (j + 0.5) * cell.y}, cell, 0.0, false);
                if (winner != -2 && winner_ != winner) return false;
                winner = winner_;
            }
        }
        return true;
    }

    // Whether the acting elements are a chain that merely hands over from one to the next here.
    bool joined_smoothly() const {
        const Candidate* previous = nullptr;
        for (std::size_t i = 0; i < count_; ++i) {
            const Candidate& c = candidates_[i];
            if (!c.reach.possible) continue;
            if (!c.reach.plain) {
                const ElementEnd& start = c.feature->frame.start.end;
                const ElementEnd& end = c.feature->frame.end.end;
                if (start.priority != Priority::both || end.priority != Priority::both || start.shape != 0 ||
                    end.shape != 0)
                    return false;
            }
            if (previous && dot(previous->foot.tangent, c.foot.tangent) < 0.99) return false;
            if (previous && std::abs(previous->foot.offset - c.foot.offset) > 0.1) return false;
            previous = &c;
        }
        return true;
    }

    bool say_of(Candidate& c, Vec2 p, Vec2 cell, double ground, bool any_level, Say& say) const {
        const Feature& f = *c.feature;
        const Vec2 q = p - c.offset;
        const Foot foot = q == centre_ - c.offset ? c.foot : foot_of(f.frame, q, std::clamp(c.foot.parameter, 0.0, 1.0));
        say.placement = place(f.frame, q, foot);
        if (!say.placement.acts) return false;
        const double width = scale_at(f.frame.width0, f.frame.width1, say.placement.along);
        if (width <= 1e-9) return false;
        const Vec2 across = normal_of(say.placement.gradient);
        say.placement.offset += say.placement.bend *
                                (cell.x * cell.x * across.x * across.x + cell.y * cell.y * across.y * across.y) / 24.0;
        say.spread = spread_of(say.placement, cell, width);
        const double b = say.placement.offset / width;
        if (!any_level) {
            if (b < f.profile->left() - say.spread.half() || b > f.profile->right() + say.spread.half()) return false;
            const double level = f.step && b > 0.0 ? f.level_right : f.level_left;
            if (std::abs(level - ground) > kLevelTolerance) return false;
        }
        const double height = scale_at(f.frame.height0, f.frame.height1, say.placement.along);
        say.value = f.level_left + height * profile_mean(*f.profile, b, say.spread, nullptr, nullptr).value;
        // A step's cut ends with its profile, at full height where a ridge stands there; a groove's edge fades out.
        const bool within = b >= f.profile->left() && b <= f.profile->right();
        say.cuts = (within || !f.step) && internal_at(*f.profile, b);
        return true;
    }

    double cell_mean(Vec2 p, Vec2 cell, double share, bool derivatives) {
        double ground = ground_;
        double value = ground_;
        int winner = -1;
        int nearest_index = -1;
        says_.resize(count_);
        spoke_.assign(count_, 0);
        if (near_step_) {
            const NearestStep nearest = nearest_step(layout_, tile_, p);
            ground = value = nearest.level;
            for (std::size_t i = 0; i < count_ && nearest_index < 0; ++i)
                if (static_cast<int>(candidates_[i].instance) == nearest.instance) nearest_index = static_cast<int>(i);
            // The nearest step's mean stands for the ground: the ground's own jump at its line is no surface.
            if (nearest_index >= 0) {
                Say& say = says_[nearest_index];
                spoke_[nearest_index] = say_of(candidates_[nearest_index], p, cell, ground, true, say);
                if (spoke_[nearest_index]) value = say.value, winner = nearest_index;
            }
        }
        if (acting_ > 0) {
            for (std::size_t i = 0; i < count_; ++i)
                if (static_cast<int>(i) != nearest_index && candidates_[i].reach.possible)
                    spoke_[i] = say_of(candidates_[i], p, cell, ground, false, says_[i]);
            // All additions before any subtraction.
            for (std::size_t i = 0; i < count_; ++i)
                if (spoke_[i] && says_[i].value > value) value = says_[i].value, winner = static_cast<int>(i);
            for (std::size_t i = 0; i < count_; ++i)
                if (spoke_[i] && says_[i].cuts && says_[i].value < value)
                    value = says_[i].value, winner = static_cast<int>(i);
        }
        winner_ = winner;
        if (derivatives && winner >= 0) differentiate(candidates_[winner], says_[winner], share);
        if (derivatives && winner < 0) differentiate_ground(ground, share);
        return value;
    }

    void differentiate(Candidate& c, const Say& say, double share) {
        start_using(c);
        const Feature& f = *c.feature;
        const int points = static_cast<int>(f.profile->b.size());
        const double along = say.placement.along;
        const double width = scale_at(f.frame.width0, f.frame.width1, along);
        const double height = scale_at(f.frame.height0, f.frame.height1, along);
        std::array<double, kMaxPoints> d_b, d_h;
        const ProfileMean mean =
            profile_mean(*f.profile, say.placement.offset / width, say.spread, d_b.data(), d_h.data());
        const double by_offset = share * height * mean.slope / width;
        for (int k = 0; k < 3; ++k) {
            c.local[kPoints + 2 * k] -= by_offset * say.placement.weight[k] * say.placement.gradient.x;
            c.local[kPoints + 2 * k + 1] -= by_offset * say.placement.weight[k] * say.placement.gradient.y;
        }
        double by_width = 0.0;
        for (int i = 0; i < points; ++i) {
            by_width += d_b[i] * f.profile->b[i];
            c.local[kProfile + i] += share * height * d_b[i];
            c.local[kProfile + points + i] += share * height * d_h[i];
        }
        by_width *= share * height / width;
        c.local[kWidths] += by_width * (1.0 - along);
        c.local[kWidths + 1] += by_width * along;
        c.local[kHeights] += share * mean.value * (1.0 - along);
        c.local[kHeights + 1] += share * mean.value * along;
        c.local[kLevel] += share;
    }

    // Ground moves with the levels of any feature that stands on it.
    void differentiate_ground(double ground, double share) {
        for (std::size_t i = 0; i < count_; ++i) {
            Candidate& c = candidates_[i];
            const Feature& f = *c.feature;
            const bool left = std::abs(f.level_left - ground) <= kLevelTolerance;
            if (!left && std::abs(f.level_right - ground) > kLevelTolerance) continue;
            start_using(c);
            c.local[kLevel] += share;
            if (!left) c.local[local_count(f) - 1] += share * f.frame.height0;
            return;
        }
    }

    const Layout& layout_;
    const int divisions_;
    const bool derivatives_;
    std::vector<Candidate> candidates_;
    std::vector<Say> says_;
    std::vector<std::uint8_t> spoke_;
    std::size_t count_ = 0;
    int acting_ = 0;
    std::size_t tile_ = 0;
    Vec2 centre_;
    double ground_ = 0.0;
    bool near_step_ = false;
    int winner_ = -1;  // of the last cell: a candidate, -1 for the ground
};

// Adds texels' equations up for one part of the map.
class Summation {
  public:
    Summation(const Layout& layout, const std::vector<ElementUnknowns>& unknowns)
        : layout_(layout), unknowns_(unknowns) {
        sum_.gradients.resize(unknowns.size());
    }

    // residual = model - map.
    Residual add(TexelModel& texel, double residual, double robust) {
        const double magnitude = std::abs(residual);
        const double weight = magnitude <= robust ? 1.0 : robust / magnitude;
        used_.clear();
        Residual entry{static_cast<float>(residual), 0.0f, -1};
        double steepest = kFlat;
        for (std::size_t i = 0; i < texel.count(); ++i) {
            Candidate& c = texel.candidate(i);
            if (!c.used) continue;
            const std::uint32_t element = layout_.instances[c.instance].element;
            reduce(element, c.local.data());
            const double* p = c.local.data() + kPoints;
            const double slope = std::hypot(p[0] + p[2] + p[4], p[1] + p[3] + p[5]);
            if (slope <= steepest) continue;
            steepest = slope;
            entry.slope = static_cast<float>(slope);
            entry.element = static_cast<std::int32_t>(element);
        }
        for (std::size_t i = 0; i < used_.size(); ++i) {
            const Row& row = rows_[i];
            std::vector<double>& gradient = sum_.gradients[used_[i]];
            if (gradient.empty()) gradient.assign(row.size(), 0.0);
            for (std::size_t k = 0; k < row.size(); ++k) gradient[k] += weight * residual * row[k];
            for (std::size_t j = i; j < used_.size(); ++j) add_pair(i, j, weight);
        }
        return entry;
    }

    Equations take() { return std::move(sum_); }

  private:
    using Row = std::vector<double>;

    void reduce(std::uint32_t element, const double* local) {
        const ElementUnknowns& u = unknowns_[element];
        std::size_t place = 0;
        while (place < used_.size() && used_[place] != element) ++place;
        if (place == used_.size()) {
            used_.push_back(element);
            if (rows_.size() < used_.size()) rows_.resize(used_.size());
            rows_[place].assign(u.unknowns.size(), 0.0);
        }
        for (const LocalTerm& term : u.terms) rows_[place][term.slot] += term.factor * local[term.local];
    }

    void add_pair(std::size_t i, std::size_t j, double weight) {
        if (used_[i] > used_[j]) std::swap(i, j);
        const Row& rows = rows_[i];
        const Row& columns = rows_[j];
        double* block = block_of(used_[i], used_[j], rows.size() * columns.size());
        for (const double a : rows) {
            const double scaled = weight * a;
            for (const double b : columns) *block++ += scaled * b;
        }
    }

    double* block_of(std::uint32_t first, std::uint32_t second, std::size_t size) {
        const std::uint64_t key = (static_cast<std::uint64_t>(first) << 32) | second;
        if (key != last_key_) {
            const auto [entry, added] = index_.try_emplace(key, sum_.values.size());
            if (added) {
                sum_.pairs.push_back({first, second, sum_.values.size()});
                sum_.values.resize(sum_.values.size() + size, 0.0);
            }
            last_key_ = key;
            last_offset_ = entry->second;
        }
        return sum_.values.data() + last_offset_;
    }

    const Layout& layout_;
    const std::vector<ElementUnknowns>& unknowns_;
    Equations sum_;
    std::unordered_map<std::uint64_t, std::size_t> index_;
    std::uint64_t last_key_ = ~0ull;
    std::size_t last_offset_ = 0;
    std::vector<std::uint32_t> used_;
    std::vector<Row> rows_;
};

// Runs work(part) for every part; which thread takes which does not matter.
template <typename Work>
void in_parallel(int parts, int threads, Work work) {
    if (threads <= 0) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    threads = std::min(threads, parts);
    std::atomic<int> next{0};
    const auto run = [&] {
        for (int part = next++; part < parts; part = next++) work(part);
    };
    std::vector<std::thread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back(run);
    run();
    for (std::thread& thread : others) thread.join();
}

}  // namespace

struct Forward::Scene {
    Layout layout;
    const Image& map;

    int parts() const { return (layout.tile_rows + kRowsPerPart - 1) / kRowsPerPart; }

    // Calls visit(x, y) for the texels of the part whose tile lists anything.
    template <typename Visit>
    void for_texels(int part, Visit visit) const {
        const int rows = kRowsPerPart * kTile;
        for (int y = part * rows; y < std::min((part + 1) * rows, layout.height); ++y) {
            for (int column = 0; column < layout.tile_columns; ++column) {
                const std::size_t tile = static_cast<std::size_t>(y / kTile) * layout.tile_columns + column;
                if (layout.first[tile] == layout.first[tile + 1]) continue;
                for (int x = column * kTile; x < std::min((column + 1) * kTile, layout.width); ++x) visit(x, y);
            }
        }
    }
};

Forward::Forward(const ResolvedPattern& pattern, const Image& map, Vec2 side)
    : scene_(new Scene{lay_out(pattern, map.width, map.height, side), map}) {}

Forward::~Forward() = default;

Prediction Forward::predict(const std::vector<ElementUnknowns>& unknowns, const ForwardOptions& options) const {
    const Scene& scene = *scene_;
    const int parts = scene.parts();
    Prediction prediction;
    prediction.parts.resize(parts);
    std::vector<std::vector<Residual>> residuals(parts);
    in_parallel(parts, options.threads, [&](int part) {
        TexelModel texel(scene.layout, options.divisions, true);
        Summation summation(scene.layout, unknowns);
        scene.for_texels(part, [&](int x, int y) {
            if (!texel.gather(x, y)) return;
            const double residual = texel.mean() - scene.map.at(x, y);
            residuals[part].push_back(summation.add(texel, residual, options.robust));
        });
        prediction.parts[part] = summation.take();
    });
    for (const std::vector<Residual>& part : residuals)
        prediction.residuals.insert(prediction.residuals.end(), part.begin(), part.end());
    return prediction;
}

Image Forward::image(const ForwardOptions& options) const {
    const Scene& scene = *scene_;
    const Layout& layout = scene.layout;
    Image out(layout.width, layout.height, static_cast<float>(layout.outer_level));
    for (std::size_t k = 0; k < layout.ground.size(); ++k)
        if (layout.ground[k] != kNearStep) out.texels[k] = layout.ground[k];
    in_parallel(scene.parts(), options.threads, [&](int part) {
        TexelModel texel(layout, options.divisions, false);
        scene.for_texels(part, [&](int x, int y) {
            if (texel.gather(x, y)) out.at(x, y) = static_cast<float>(texel.mean());
        });
    });
    return out;
}

double robust_cost(const std::vector<Residual>& residuals, double threshold) {
    double sum = 0.0;
    for (const Residual& residual : residuals) {
        const double r = std::abs(residual.value);
        sum += r <= threshold ? 0.5 * r * r : threshold * (r - 0.5 * threshold);
    }
    return sum;
}

}  // namespace burin::refinement
