#include "refine_forward.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <unordered_map>

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
            if (a == 0.0) {  // most of them where the texel is flat
                block += columns.size();
                continue;
            }
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

    // Calls visit(x, y) for the texels of the part whose tile lists anything, tile by tile.
    template <typename Visit>
    void for_texels(int part, Visit visit) const {
        const int last_row = std::min((part + 1) * kRowsPerPart, layout.tile_rows);
        for (int row = part * kRowsPerPart; row < last_row; ++row) {
            for (int column = 0; column < layout.tile_columns; ++column) {
                const std::size_t tile = static_cast<std::size_t>(row) * layout.tile_columns + column;
                if (layout.first[tile] == layout.first[tile + 1]) continue;
                for (int y = row * kTile; y < std::min((row + 1) * kTile, layout.height); ++y)
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
        TexelModel texel(scene.layout, options, true);
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
        TexelModel texel(layout, options, false);
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
