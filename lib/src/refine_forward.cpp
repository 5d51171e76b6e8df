#include "refine_forward.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "parallel.hpp"
#include "refine_scene.hpp"
#include "refine_texel.hpp"

namespace burin::refinement {
namespace {

constexpr int kRowsPerPart = 4;      // tile rows that are summed together, whatever the number of threads
constexpr double kFlat = 1e-7;       // derivative by place, per texel, that counts as none

// Adds texels' equations up for one part of the map.
class Summation {
  public:
    Summation(const Layout& layout, const std::vector<ElementUnknowns>& unknowns)
        : layout_(layout), unknowns_(unknowns) {
        sum_.gradients.resize(unknowns.size());
    }

    // Fills in which element matters most to the residual.
    void add(TexelModel& texel, double residual, double robust, Residual& entry) {
        const double magnitude = std::abs(residual);
        const double weight = entry.weight * (magnitude <= robust ? 1.0 : robust / magnitude);
        used_.clear();
        double steepest = kFlat;
        for (std::size_t i = 0; i < texel.count(); ++i) {
            Candidate& c = texel.candidate(i);
            if (!c.used) continue;
            const std::uint32_t element = layout_.instances[c.instance].element;
            reduce(element, c.local.data());
            const double* p = c.local.data() + kPoints;
            const double x = p[0] + p[2] + p[4], y = p[1] + p[3] + p[5], slope = std::sqrt(x * x + y * y);
            if (slope <= steepest) continue;
            steepest = slope;
            entry.slope = static_cast<float>(slope);
            entry.element = static_cast<std::int32_t>(element);
        }
        for (std::size_t i = 0; i < used_.size(); ++i) add_row(i, weight, weight * residual);
    }

    // Of a texel that no feature is near: all it shows is the level of its region.
    void add_ground(double level, double residual, double robust, double texels) {
        const double magnitude = std::abs(residual);
        const double weight = texels * (magnitude <= robust ? 1.0 : robust / magnitude);
        auto sum = std::find_if(grounds_.begin(), grounds_.end(), [&](const Ground& g) { return g.level == level; });
        if (sum == grounds_.end()) sum = grounds_.insert(sum, {level, 0.0, 0.0});
        sum->weight += weight;
        sum->residual += weight * residual;
    }

    Equations take() {
        for (const Ground& ground : grounds_) add_level(ground);
        return std::move(sum_);
    }

  private:
    // Most unknowns of an element have no say in one texel.
    struct Entry {
        int slot = 0;
        double value = 0.0;
    };
    using Row = std::vector<Entry>;

    struct Ground {
        double level = 0.0, weight = 0.0, residual = 0.0;  // sums over texels
    };

    // The level moves with any feature that stands on it.
    void add_level(const Ground& ground) {
        for (std::uint32_t element = 0; element < layout_.features.size(); ++element) {
            const Feature& feature = layout_.features[element];
            const bool left = std::abs(feature.level_left - ground.level) <= kLevelTolerance;
            if (!left && std::abs(feature.level_right - ground.level) > kLevelTolerance) continue;
            std::array<double, kMaxLocal> local{};
            local[kLevel] = 1.0;
            if (!left) local[local_count(feature) - 1] = feature.frame.height0;
            used_.clear();
            reduce(element, local.data());
            add_row(0, ground.weight, ground.residual);
            return;
        }
    }

    // Of the used element at `place`; with its pairs to those after it.
    void add_row(std::size_t place, double weight, double weighted_residual) {
        std::vector<double>& gradient = sum_.gradients[used_[place]];
        if (gradient.empty()) gradient.assign(unknowns_[used_[place]].unknowns.size(), 0.0);
        for (const Entry& entry : rows_[place]) gradient[entry.slot] += weighted_residual * entry.value;
        for (std::size_t other = place; other < used_.size(); ++other) add_pair(place, other, weight);
    }

    void reduce(std::uint32_t element, const double* local) {
        const ElementUnknowns& u = unknowns_[element];
        std::size_t place = 0;
        while (place < used_.size() && used_[place] != element) ++place;
        if (place == used_.size()) {
            used_.push_back(element);
            if (rows_.size() < used_.size()) rows_.resize(used_.size());
            rows_[place].clear();
        }
        dense_.assign(u.unknowns.size(), 0.0);
        for (const Entry& entry : rows_[place]) dense_[entry.slot] = entry.value;
        for (const LocalTerm& term : u.terms) dense_[term.slot] += term.factor * local[term.local];
        rows_[place].clear();
        for (std::size_t slot = 0; slot < dense_.size(); ++slot)
            if (dense_[slot] != 0.0) rows_[place].push_back({static_cast<int>(slot), dense_[slot]});
    }

    // Of an element with itself, only what lies on and above the diagonal.
    void add_pair(std::size_t i, std::size_t j, double weight) {
        if (used_[i] > used_[j]) std::swap(i, j);
        const std::size_t rows = unknowns_[used_[i]].unknowns.size(), columns = unknowns_[used_[j]].unknowns.size();
        double* const block = block_of(used_[i], used_[j], rows * columns);
        for (std::size_t a = 0; a < rows_[i].size(); ++a) {
            const double scaled = weight * rows_[i][a].value;
            double* const row = block + static_cast<std::size_t>(rows_[i][a].slot) * columns;
            for (std::size_t b = i == j ? a : 0; b < rows_[j].size(); ++b) row[rows_[j][b].slot] += scaled * rows_[j][b].value;
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
    std::vector<double> dense_;
    std::vector<Ground> grounds_;
};

}  // namespace

struct Forward::Scene {
    Layout layout;
    const Image& map;
    const Sampling& sampling;

    int parts() const { return (layout.tile_rows + kRowsPerPart - 1) / kRowsPerPart; }

    // Calls visit(x, y) for the texels of the part, tile by tile.
    template <typename Visit>
    void for_texels(int part, Visit visit) const {
        const int last_row = std::min((part + 1) * kRowsPerPart, layout.tile_rows);
        for (int row = part * kRowsPerPart; row < last_row; ++row)
            for (int column = 0; column < layout.tile_columns; ++column)
                for (int y = row * kTile; y < std::min((row + 1) * kTile, layout.height); ++y)
                    for (int x = column * kTile; x < std::min((column + 1) * kTile, layout.width); ++x) visit(x, y);
    }

    // Residuals of one part of the map, and its equations.
    void predict(int part, const std::vector<ElementUnknowns>& unknowns, const ForwardOptions& options,
                 Prediction& out) const {
        TexelModel texel(layout, options, options.equations);
        Summation summation(layout, unknowns);
        for_texels(part, [&](int x, int y) {
            const int weight = sampling.at(x, y);
            if (weight == 0) return;
            const std::uint32_t index = static_cast<std::uint32_t>(y) * layout.width + x;
            const bool near = texel.gather(x, y);
            const double residual = (near ? texel.mean() : layout.ground_at(index)) - map.texels[index];
            Residual entry{static_cast<float>(residual), static_cast<float>(weight), index};
            if (near && options.equations) summation.add(texel, residual, options.robust, entry);
            if (!near && options.equations) summation.add_ground(layout.ground_at(index), residual, options.robust, weight);
            (near ? out.residuals : out.far).push_back(entry);
        });
        out.parts.push_back(summation.take());
    }
};

Forward::Forward(const ResolvedPattern& pattern, const Image& map, Vec2 side, const Sampling& sampling,
                 int threads)
    : scene_(new Scene{lay_out(pattern, map.width, map.height, side, threads), map, sampling}) {}

Forward::~Forward() = default;

Prediction Forward::predict(const std::vector<ElementUnknowns>& unknowns, const ForwardOptions& options) const {
    std::vector<Prediction> parts(scene_->parts());
    for_each_piece(parts.size(), options.threads,
                   [&](std::size_t part) { scene_->predict(static_cast<int>(part), unknowns, options, parts[part]); });
    Prediction all;
    for (Prediction& part : parts) {
        all.parts.push_back(std::move(part.parts.front()));
        all.residuals.insert(all.residuals.end(), part.residuals.begin(), part.residuals.end());
        all.far.insert(all.far.end(), part.far.begin(), part.far.end());
    }
    return all;
}

Image Forward::image(const ForwardOptions& options) const {
    const Layout& layout = scene_->layout;
    Image out(layout.width, layout.height);
    for_each_piece(static_cast<std::size_t>(scene_->parts()), options.threads, [&](std::size_t part) {
        TexelModel texel(layout, options, false);
        scene_->for_texels(static_cast<int>(part), [&](int x, int y) {
            const double ground = layout.ground_at(static_cast<std::size_t>(y) * layout.width + x);
            out.at(x, y) = static_cast<float>(texel.gather(x, y) ? texel.mean() : ground);
        });
    });
    return out;
}

double robust_cost(const Residual& residual, double threshold) {
    const double r = std::abs(residual.value);
    return residual.weight * (r <= threshold ? 0.5 * r * r : threshold * (r - 0.5 * threshold));
}

double robust_cost(const std::vector<Residual>& residuals, double threshold) {
    double sum = 0.0;
    for (const Residual& residual : residuals) sum += robust_cost(residual, threshold);
    return sum;
}

double root_mean_square(const std::vector<Residual>& residuals) {
    double sum = 0.0, weights = 0.0;
    for (const Residual& r : residuals) {
        sum += double(r.weight) * r.value * r.value;
        weights += r.weight;
    }
    return weights > 0.0 ? std::sqrt(sum / weights) : 0.0;
}

}  // namespace burin::refinement
