// Least squares over the control polygon: Levenberg-Marquardt on the distances of the points to the curve.
//
// Unknowns are the vertices and the fractions at which joints lie on their sides. The distance of a point to
// the curve changes, to first order, by the normal component of the change of its foot, so each residual
// touches at most three neighbouring vertices and two fractions: the normal equations are a narrow band.
#include <algorithm>
#include <array>
#include <cmath>

#include "fit_chain.hpp"

namespace burin::fit {

namespace {

// Symmetric positive definite matrix, lower envelope by rows, and its Cholesky solution.
class Envelope {
  public:
    explicit Envelope(std::size_t n) : first_(n), start_(n) {
        for (std::size_t i = 0; i < n; ++i) first_[i] = i;
    }
    void touch(std::size_t i, std::size_t j) {
        if (j > i) std::swap(i, j);
        first_[i] = std::min(first_[i], j);
    }
    void allocate() {
        std::size_t total = 0;
        for (std::size_t i = 0; i < first_.size(); ++i) {
            start_[i] = total;
            total += i - first_[i] + 1;
        }
        value_.assign(total, 0.0);
    }
    void clear() { std::fill(value_.begin(), value_.end(), 0.0); }
    double& at(std::size_t i, std::size_t j) { return value_[start_[i] + j - first_[i]]; }
    std::size_t size() const { return first_.size(); }

    // Factors in place; false when a pivot is not positive.
    bool factor() {
        for (std::size_t i = 0; i < size(); ++i) {
            for (std::size_t j = first_[i]; j <= i; ++j) {
                double sum = at(i, j);
                for (std::size_t k = std::max(first_[i], first_[j]); k < j; ++k) sum -= at(i, k) * at(j, k);
                if (j < i) {
                    at(i, j) = sum / at(j, j);
                } else {
                    if (!(sum > 0.0)) return false;
                    at(i, i) = std::sqrt(sum);
                }
            }
        }
        return true;
    }
    void solve(std::vector<double>& x) {
        for (std::size_t i = 0; i < size(); ++i) {
            for (std::size_t j = first_[i]; j < i; ++j) x[i] -= at(i, j) * x[j];
            x[i] /= at(i, i);
        }
        for (std::size_t i = size(); i-- > 0;) {
            x[i] /= at(i, i);
            for (std::size_t j = first_[i]; j < i; ++j) x[j] -= at(i, j) * x[i];
        }
    }

  private:
    std::vector<std::size_t> first_, start_;
    std::vector<double> value_;
};

constexpr int kMost = 8;  // unknowns that one piece depends on

// Normal equations of one piece: local unknowns, their columns (-1: fixed), J^T J and J^T r.
struct Local {
    std::array<int, kMost> column;
    std::array<std::array<double, kMost>, kMost> square{};
    std::array<double, kMost> right{};
    double sum = 0.0;
    int count = 0;

    void add(const std::array<double, kMost>& slope, double residual, double weight) {
        for (int i = 0; i < count; ++i) {
            const double s = weight * slope[static_cast<std::size_t>(i)];
            right[static_cast<std::size_t>(i)] += s * residual;
            for (int j = 0; j <= i; ++j)
                square[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] +=
                    s * slope[static_cast<std::size_t>(j)];
        }
        sum += weight * residual * residual;
    }
};

class Refiner {
  public:
    Refiner(Chain& chain, const Points& points, const FitOptions& options, Window window, Aim aim);
    double run(int iterations);

  private:
    struct Columns {
        int vertex = -1, s0 = -1, s1 = -1;
    };

    void number_unknowns();
    void number(long k, bool vertex_free);
    void shape_envelope();
    template <typename Visit>
    void for_each_piece(Visit visit) const;
    Local quadratic(long k);
    Local line(long k);
    Local end_stop(long k, bool at_start);
    std::array<int, kMost> columns_of(long k, bool quadratic) const;
    Local balance(long k);
    Local anchor(long k);
    double assemble(bool with_matrix);
    bool is_sound(long k) const;
    bool has_strayed(long k) const;
    void take_back(const Chain& saved);
    template <typename Visit>
    void for_each_vertex(Visit visit) const;
    void set_anchors();
    void step(const std::vector<double>& change);
    double weight(long i, double distance) const;
    // A long piece is determined well enough by some of its points; the tolerance is held against all of
    // them.
    long stride_of(PointRange range) const {
        return std::max(1L, (range.end - range.begin) / (whole_ ? 48 : 20));
    }
    void mark_ignored();
    PointRange looked_at(PointRange range, long before, long after) const;
    Columns& at(long k) { return columns_[static_cast<std::size_t>(chain_.wrap(k))]; }
    const Columns& at(long k) const { return columns_[static_cast<std::size_t>(chain_.wrap(k))]; }

    Chain& chain_;
    const Points& points_;
    const FitOptions& options_;
    Window window_;
    Aim aim_;
    bool whole_;
    int unknowns_ = 0;
    std::vector<Columns> columns_;
    Envelope matrix_{0};
    // Points near each corner. They are chosen before the first step and kept: were they to follow the
    // corner, a step could lower the sum by driving points out of it.
    std::vector<PointRange> ignored_;
    struct Anchor {
        bool held = false;
        Vec2 p;
        double reach = 0.0;
    };
    std::vector<Anchor> anchors_;     // by vertex
    std::vector<char> sound_before_;  // by vertex
    std::vector<long> spoilt_;
    std::vector<double> right_;
};

Refiner::Refiner(Chain& chain, const Points& points, const FitOptions& options, Window window, Aim aim)
    : chain_(chain),
      points_(points),
      options_(options),
      window_(window),
      aim_(aim),
      whole_(window.count >= chain.size()) {
    columns_.resize(chain.vertices.size());
    sound_before_.resize(chain.vertices.size());
    number_unknowns();
    matrix_ = Envelope(static_cast<std::size_t>(unknowns_));
    shape_envelope();
    right_.resize(static_cast<std::size_t>(unknowns_));
    mark_ignored();
    set_anchors();
}

// Side k's fractions that may move, and vertex k when it may.
void Refiner::number(long k, bool vertex_free) {
    Columns& c = at(k);
    if (vertex_free) {
        const bool pinned = !chain_.closed &&
                            ((k == 0 && options_.pin_start) || (k == chain_.size() - 1 && options_.pin_end));
        if (!pinned) c.vertex = unknowns_, unknowns_ += 2;
    }
    if (!chain_.closed && (k < 0 || k >= chain_.sides())) return;
    const bool start_moves = !chain_.at(k).corner;
    const bool end_moves = !chain_.at(k + 1).corner;
    if (chain_.at(k).line) {
        if (start_moves) c.s0 = unknowns_++;
        if (end_moves) c.s1 = unknowns_++;
    } else if (start_moves && end_moves) {
        c.s0 = c.s1 = unknowns_++;
    }
}

void Refiner::number_unknowns() {
    if (!whole_) {
        if (chain_.closed || window_.first > 0) number(window_.first - 1, false);
        for (long k = 0; k < window_.count; ++k) number(window_.first + k, true);
        return;
    }
    const long n = chain_.size();
    // A closed chain is folded, 0, n-1, 1, n-2, ..., so that neighbours across the seam stay close in the
    // matrix.
    for (long i = 0; i < n; ++i) number(chain_.closed ? (i % 2 == 0 ? i / 2 : n - 1 - i / 2) : i, true);
}

template <typename Visit>
void Refiner::for_each_piece(Visit visit) const {
    long first = whole_ ? 0 : window_.first - 1;
    long last = whole_ ? chain_.size() - 1 : window_.first + window_.count;
    if (!chain_.closed) first = std::max(first, 0L), last = std::min(last, chain_.size() - 1);
    for (long k = first; k <= last; ++k) {
        if (!chain_.at(k).corner) visit(k, true);
        if ((chain_.closed || k < chain_.sides()) && chain_.at(k).line) visit(k, false);
    }
}

template <typename Visit>
void Refiner::for_each_vertex(Visit visit) const {
    long first = whole_ ? 0 : window_.first - 1;
    long last = whole_ ? chain_.size() - 1 : window_.first + window_.count;
    if (!chain_.closed) first = std::max(first, 0L), last = std::min(last, chain_.size() - 1);
    for (long k = first; k <= last; ++k) visit(k);
}

std::array<int, kMost> Refiner::columns_of(long k, bool quadratic) const {
    const auto pair = [](int c, int i) { return c < 0 ? -1 : c + i; };
    const Columns& c = at(k);
    const Columns& n = at(k + 1);
    if (!quadratic)
        return {pair(c.vertex, 0), pair(c.vertex, 1), pair(n.vertex, 0), pair(n.vertex, 1), -1, -1, -1, -1};
    const Columns& b = at(k - 1);
    return {pair(b.vertex, 0),
            pair(b.vertex, 1),
            pair(c.vertex, 0),
            pair(c.vertex, 1),
            pair(n.vertex, 0),
            pair(n.vertex, 1),
            b.s1,
            c.s0};
}

void Refiner::shape_envelope() {
    for_each_piece([&](long k, bool quadratic) {
        const auto columns = columns_of(k, quadratic);
        for (int a : columns)
            for (int b : columns)
                if (a >= 0 && b >= 0) matrix_.touch(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
    });
    matrix_.allocate();
}

double Refiner::weight(long i, double distance) const {
    // The fourth power makes the sum one of sixth powers, whose optimum is near that of the largest error;
    // the bound keeps one bad point from taking over.
    if (aim_ == Aim::mean_square) return points_.weight(i);
    const double over = distance * distance / (options_.tolerance * options_.tolerance);
    return points_.weight(i) * (0.02 + std::min(over * over, 8.0));
}

void Refiner::mark_ignored() {
    ignored_.resize(chain_.vertices.size());
    const long first = whole_ ? 0 : window_.first - 1;
    const long last = whole_ ? chain_.size() - 1 : window_.first + window_.count;
    for (long k = first; k <= last; ++k) {
        if (!chain_.closed && (k <= 0 || k >= chain_.size() - 1)) continue;
        if (!chain_.at(k).corner) continue;
        const PointRange r = ignored_range(chain_, points_, k, options_.corner_reach);
        const long lap = chain_.turn * chain_.turns(k);
        ignored_[static_cast<std::size_t>(chain_.wrap(k))] = {r.begin - lap, r.end - lap};
    }
}

// Points of [begin, end) but for those near a corner at vertex `before` or `after`.
PointRange Refiner::looked_at(PointRange range, long before, long after) const {
    if (chain_.at(before).corner)
        range.begin = std::max(range.begin, ignored_[static_cast<std::size_t>(chain_.wrap(before))].end +
                                                chain_.turn * chain_.turns(before));
    if (chain_.at(after).corner && (chain_.closed || after < chain_.size() - 1))
        range.end = std::min(range.end, ignored_[static_cast<std::size_t>(chain_.wrap(after))].begin +
                                            chain_.turn * chain_.turns(after));
    return range;
}

Local Refiner::quadratic(long k) {
    Local local;
    local.column = columns_of(k, true);
    local.count = kMost;
    const Vec2 before = chain_.position(k - 1);
    const Vec2 control = chain_.position(k);
    const Vec2 after = chain_.position(k + 1);
    const double s_in = chain_.at(k - 1).s1;
    const double s_out = chain_.at(k).s0;
    const Vec2 p0 = lerp(before, control, s_in);
    const Vec2 p2 = lerp(control, after, s_out);
    const PointRange range = looked_at({chain_.begin(k), chain_.end(k)}, chain_.at(k - 1).line ? k : k - 1,
                                       chain_.at(k).line ? k : k + 1);
    double t = 0.0;
    const long stride = stride_of(range);
    for (long i = range.begin; i < range.end; i += stride) {
        t = closest_parameter(p0, control, p2, points_[i], t);
        const Vec2 slope = lerp(control - p0, p2 - control, t);
        const Vec2 n = normal_of(slope) * (1.0 / std::sqrt(std::max(dot(slope, slope), 1e-24)));
        const double w0 = (1.0 - t) * (1.0 - t), w1 = 2.0 * t * (1.0 - t), w2 = t * t;
        const Vec2 foot = p0 * w0 + control * w1 + p2 * w2;
        const double residual = dot(n, points_[i] - foot);
        const double a = w0 * (1.0 - s_in), b = w0 * s_in + w1 + w2 * (1.0 - s_out), c = w2 * s_out;
        local.add({a * n.x, a * n.y, b * n.x, b * n.y, c * n.x, c * n.y, w0 * dot(n, control - before),
                   w2 * dot(n, after - control)},
                  residual, static_cast<double>(stride) * weight(i, residual));
    }
    return local;
}

Local Refiner::line(long k) {
    Local local;
    local.column = columns_of(k, false);
    local.count = 4;
    const Vec2 a = chain_.position(k);
    const Vec2 side = chain_.position(k + 1) - a;
    const Vec2 n = normal_of(unit(side));
    const double scale = 1.0 / std::max(dot(side, side), 1e-12);
    const PointRange all{chain_.end(k), chain_.begin(k + 1)};
    PointRange range = looked_at(all, k, k + 1);
    double trust = 1.0;
    // A side so short that its corners claim all its points: they are the best there is.
    if (range.end - range.begin < 2) range = all, trust = 0.1;
    const long stride = stride_of(range);
    trust *= static_cast<double>(stride);
    for (long i = range.begin; i < range.end; i += stride) {
        const Vec2 p = points_[i] - a;
        const double along = dot(p, side) * scale;
        const double residual = dot(n, p);
        const double c0 = 1.0 - along;
        local.add({c0 * n.x, c0 * n.y, along * n.x, along * n.y, 0, 0, 0, 0}, residual,
                  trust * weight(i, residual));
    }
    return local;
}

// Keeps the free end of an open chain beside its end point.
Local Refiner::end_stop(long k, bool at_start) {
    Local local;
    local.column.fill(-1);
    local.count = 2;
    const Columns& c = at(k);
    if (c.vertex < 0) return local;
    local.column[0] = c.vertex;
    local.column[1] = c.vertex + 1;
    const Vec2 v = chain_.position(k);
    const Vec2 t = unit(at_start ? chain_.position(1) - v : v - chain_.position(k - 1));
    const Vec2 target = points_[at_start ? 0 : points_.count - 1];
    local.add({t.x, t.y, 0, 0, 0, 0, 0, 0}, dot(t, target - v), 1.0);
    return local;
}

// The control point of a nearly straight quadratic could slide along it at no cost. A weak pull to the middle
// decides: at a third of the length off, it weighs as much as an error of a tenth of the tolerance in every
// point.
Local Refiner::balance(long k) {
    Local local;
    local.column.fill(-1);
    local.count = 2;
    const Columns& c = at(k);
    if (c.vertex < 0) return local;
    local.column[0] = c.vertex;
    local.column[1] = c.vertex + 1;
    const Vec2 p0 = chain_.joint_in(k), p2 = chain_.joint_out(k);
    const double chord = std::max(length(p2 - p0), 1e-9);
    const Vec2 t = (p2 - p0) * (1.0 / chord);
    const double share = 0.3 * options_.tolerance / chord;
    const double pull = share * share * static_cast<double>(std::max(4L, chain_.end(k) - chain_.begin(k)));
    local.add({t.x, t.y, 0, 0, 0, 0, 0, 0}, dot(t, (p0 + p2) * 0.5 - chain_.position(k)), pull);
    return local;
}

// A corner whose one side has hardly a point could run away along the other. It is tied, weakly, to the
// points about it.
Local Refiner::anchor(long k) {
    Local local;
    local.column.fill(-1);
    local.count = 2;
    const Columns& c = at(k);
    local.column[0] = c.vertex;
    local.column[1] = c.vertex + 1;
    constexpr double kPull =
        0.01;  // of a point's weight: moves a corner between sides of three points by 1/300 texel
    const Vec2 d = anchors_[static_cast<std::size_t>(k)].p - chain_.position(k);
    local.add({1, 0, 0, 0, 0, 0, 0, 0}, d.x, kPull);
    local.add({0, 1, 0, 0, 0, 0, 0, 0}, d.y, kPull);
    return local;
}

void Refiner::set_anchors() {
    anchors_.resize(chain_.vertices.size());
    for (std::size_t i = 0; i < anchors_.size(); ++i) {
        const long k = static_cast<long>(i);
        if (!chain_.at(k).corner || at(k).vertex < 0) continue;
        if (!chain_.closed && (k == 0 || k == chain_.size() - 1)) continue;
        const long border = std::clamp(chain_.begin(k), points_.first() + 1, points_.last());
        anchors_[i].p = (points_[border - 1] + points_[border]) * 0.5;
        anchors_[i].held = true;
        const Vec2 in = unit(chain_.position(k) - chain_.position(k - 1));
        const Vec2 out = unit(chain_.position(k + 1) - chain_.position(k));
        const double now = length(chain_.position(k) - anchors_[i].p);
        const double spacing = length(points_[border] - points_[border - 1]);
        anchors_[i].reach = std::max(
            now, 1.5 * corner_radius(in, out, options_.corner_reach) + 2.0 * options_.tolerance + spacing);
    }
}

// Whether the quadratic at vertex k still stands for its points: its control point lies between its ends,
// seen along the chord, so that no tangent runs backwards; it turns by less than 140 degrees; and it is not
// far longer than its points.
bool Refiner::is_sound(long k) const {
    const Vec2 p0 = chain_.joint_in(k), p2 = chain_.joint_out(k);
    const Vec2 chord = p2 - p0, in = chain_.position(k) - p0, out = p2 - chain_.position(k);
    const double along = dot(in, chord), whole = dot(chord, chord);
    const double arms = length(in) + length(out);
    const long first = chain_.begin(k), last = std::max(first, chain_.end(k) - 1);
    const double row = points_.arc(std::clamp(last, points_.first(), points_.last())) -
                       points_.arc(std::clamp(first, points_.first(), points_.last()));
    return along > 0.02 * whole && along < 0.98 * whole && dot(in, out) > -0.77 * length(in) * length(out) &&
           arms < 2.0 * row + 4.0 * std::max(options_.corner_reach, options_.tolerance);
}

bool Refiner::has_strayed(long k) const {
    const Anchor& anchor = anchors_[static_cast<std::size_t>(chain_.wrap(k))];
    return anchor.held && length(chain_.at(k).v - anchor.p) > anchor.reach;
}

// Takes back the step where it has spoilt a quadratic or carried off a corner: there the vertex and its
// neighbours stay as they were, and the rest of the chain goes on.
void Refiner::take_back(const Chain& saved) {
    const auto restore = [&](long k) {
        if (!chain_.closed && (k < 0 || k >= chain_.size())) return;
        Vertex& now = chain_.at(k);
        const Vertex& before = saved.at(k);
        now.v = before.v;
        now.s0 = before.s0;
        now.s1 = before.s1;
    };
    // Restoring one may spoil the next: a few rounds, then what is left is for the sum of squares to judge.
    for (int round = 0; round < 3; ++round) {
        spoilt_.clear();
        for_each_vertex([&](long k) {
            if (chain_.at(k).corner
                    ? has_strayed(k)
                    : (!is_sound(k) && sound_before_[static_cast<std::size_t>(chain_.wrap(k))]))
                spoilt_.push_back(k);
        });
        if (spoilt_.empty()) return;
        for (const long k : spoilt_)
            for (const long i : {k - 1, k, k + 1}) restore(i);
    }
}

double Refiner::assemble(bool with_matrix) {
    double sum = 0.0;
    const auto scatter = [&](const Local& local) {
        sum += local.sum;
        if (!with_matrix) return;
        for (int i = 0; i < local.count; ++i) {
            const int a = local.column[static_cast<std::size_t>(i)];
            if (a < 0) continue;
            right_[static_cast<std::size_t>(a)] += local.right[static_cast<std::size_t>(i)];
            for (int j = 0; j <= i; ++j) {
                const int b = local.column[static_cast<std::size_t>(j)];
                if (b < 0) continue;
                const double v = local.square[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
                // The same vertex may enter twice in a chain of one or two: both halves then fall on the
                // diagonal.
                const double twice = (a == b && i != j) ? 2.0 : 1.0;
                matrix_.at(static_cast<std::size_t>(std::max(a, b)),
                           static_cast<std::size_t>(std::min(a, b))) += v * twice;
            }
        }
    };
    if (with_matrix) {
        matrix_.clear();
        std::fill(right_.begin(), right_.end(), 0.0);
    }
    for_each_piece([&](long k, bool is_quadratic) {
        scatter(is_quadratic ? quadratic(k) : line(k));
        if (is_quadratic) scatter(balance(k));
    });
    for (std::size_t k = 0; k < anchors_.size(); ++k)
        if (anchors_[k].held) scatter(anchor(static_cast<long>(k)));
    if (!chain_.closed && at(0).vertex >= 0) scatter(end_stop(0, true));
    if (!chain_.closed && at(chain_.size() - 1).vertex >= 0) scatter(end_stop(chain_.size() - 1, false));
    return sum;
}

void Refiner::step(const std::vector<double>& change) {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        const Columns& c = columns_[k];
        if (c.vertex < 0) continue;
        chain_.vertices[k].v.x += change[static_cast<std::size_t>(c.vertex)];
        chain_.vertices[k].v.y += change[static_cast<std::size_t>(c.vertex) + 1];
    }
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        const Columns& c = columns_[k];
        if (c.s0 < 0 && c.s1 < 0) continue;
        Vertex& vertex = chain_.vertices[k];
        // An arm shorter than a tenth of the tolerance would give a joint whose tangent rounding decides.
        const double side = length(chain_.position(static_cast<long>(k) + 1) - vertex.v);
        const double low = std::min(0.02, 0.1 * options_.tolerance / std::max(side, 1e-9));
        if (c.s0 >= 0)
            vertex.s0 = std::clamp(vertex.s0 + change[static_cast<std::size_t>(c.s0)], low, 1.0 - low);
        if (c.s1 >= 0 && c.s1 != c.s0)
            vertex.s1 = std::clamp(vertex.s1 + change[static_cast<std::size_t>(c.s1)], low, 1.0 - low);
        if (c.s1 >= 0 && c.s1 == c.s0) vertex.s1 = vertex.s0;
        if (vertex.line && vertex.s1 < vertex.s0) vertex.s0 = vertex.s1 = 0.5 * (vertex.s0 + vertex.s1);
    }
}

double Refiner::run(int iterations) {
    if (unknowns_ == 0) return assemble(false);
    double damping = 1e-3;
    double cost = assemble(true);
    for (int i = 0; i < iterations && damping < 1e6; ++i) {
        const Chain saved = chain_;
        for (std::size_t d = 0; d < matrix_.size(); ++d)
            matrix_.at(d, d) = matrix_.at(d, d) * (1.0 + damping) + 1e-7;
        std::vector<double> change = right_;
        bool sound = matrix_.factor();
        if (sound) {
            matrix_.solve(change);
            for_each_vertex([&](long k) {
                sound_before_[static_cast<std::size_t>(chain_.wrap(k))] = !chain_.at(k).corner && is_sound(k);
            });
            step(change);
            take_back(saved);
        }
        if (sound) assign_points(chain_, points_, window_);
        const double before = cost;
        const double after = sound ? assemble(true) : before;
        if (after < before) {
            cost = after;
            damping *= 0.2;
            if (after > before * 0.995) break;
        } else {
            chain_ = saved;
            assemble(true);
            damping = std::max(damping * 10.0, 1e-4);
        }
    }
    return cost;
}

}  // namespace

double refine_chain(Chain& chain, const Points& points, const FitOptions& options, Window window, Aim aim,
                    int iterations) {
    return Refiner(chain, points, options, window, aim).run(iterations);
}

}  // namespace burin::fit
