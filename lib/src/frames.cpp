// Least squares of a quadratic surface at every vertex.
#include <burin/frames.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

#include <burin/geometry.hpp>

namespace burin {
namespace {

using Vec3 = std::array<double, 3>;

Vec3 operator+(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vec3 operator-(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 operator*(const Vec3& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
double dot3(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length3(const Vec3& a) { return std::sqrt(dot3(a, a)); }

// Normal equations of N unknowns and C right sides, summed row by row; solved with a ridge that decides what the rows
// leave open in favour of small second derivatives.
template <std::size_t N, std::size_t C>
struct LeastSquares {
    std::array<std::array<double, N>, N> matrix{};
    std::array<std::array<double, C>, N> right{};

    void add(const std::array<double, N>& row, const std::array<double, C>& value, double weight) {
        for (std::size_t i = 0; i < N; ++i) {
            for (std::size_t j = 0; j < N; ++j) matrix[i][j] += weight * row[i] * row[j];
            for (std::size_t c = 0; c < C; ++c) right[i][c] += weight * row[i] * value[c];
        }
    }

    // Elimination without pivots: the matrix is positive definite. `firm`: unknowns before it carry a millionth of the ridge.
    std::array<std::array<double, C>, N> solve(std::size_t firm) {
        double trace = 1e-300;
        for (std::size_t i = 0; i < N; ++i) trace += matrix[i][i];
        for (std::size_t i = 0; i < N; ++i) matrix[i][i] += trace * (i < firm ? 1e-15 : 1e-9);
        for (std::size_t k = 0; k < N; ++k)
            for (std::size_t i = k + 1; i < N; ++i) {
                const double factor = matrix[i][k] / matrix[k][k];
                for (std::size_t j = k; j < N; ++j) matrix[i][j] -= factor * matrix[k][j];
                for (std::size_t c = 0; c < C; ++c) right[i][c] -= factor * right[k][c];
            }
        for (std::size_t k = N; k-- > 0;)
            for (std::size_t c = 0; c < C; ++c) {
                for (std::size_t j = k + 1; j < N; ++j) right[k][c] -= matrix[k][j] * right[j][c];
                right[k][c] /= matrix[k][k];
            }
        return right;
    }
};

// The mesh with vertices that are stored more than once joined, and who lies one edge away from whom.
class Neighbourhood {
  public:
    explicit Neighbourhood(const SurfaceMesh& mesh) : mesh_(mesh), same_(mesh.positions.size() / 3) {
        join_vertices();
        std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = same_[mesh.indices[i + k]], b = same_[mesh.indices[i + (k + 1) % 3]];
                if (a == b) continue;
                edges.push_back({a, b});
                edges.push_back({b, a});
            }
        sum_directions();
        count_borders(edges);
        std::sort(edges.begin(), edges.end());
        edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
        first_.assign(same_.size() + 1, 0);
        for (const auto& [from, to] : edges) ++first_[from + 1], near_.push_back(to);
        for (std::size_t i = 0; i + 1 < first_.size(); ++i) first_[i + 1] += first_[i];
    }

    std::uint32_t joined(std::size_t vertex) const { return same_[vertex]; }
    Vec3 position(std::uint32_t i) const { return three(mesh_.positions, i); }
    Vec3 normal(std::uint32_t i) const { return three(mesh_.normals, i); }
    Vec2 uv(std::uint32_t i) const { return {double(mesh_.uvs[2 * i]), double(mesh_.uvs[2 * i + 1])}; }

    // Means of the derivatives over the triangles around, by their area in uv; zero where they have none.
    Vec3 mean_du(std::uint32_t i) const { return means_[i].du * (1.0 / std::max(means_[i].area, 1e-300)); }
    Vec3 mean_dv(std::uint32_t i) const { return means_[i].dv * (1.0 / std::max(means_[i].area, 1e-300)); }

    // One edge away; two where the vertex lies on a border, since those on one side alone say too little.
    std::vector<std::uint32_t> around(std::uint32_t i) const {
        std::vector<std::uint32_t> found(near_.begin() + first_[i], near_.begin() + first_[i + 1]);
        if (!border_[i]) return found;
        const std::size_t first_ring = found.size();
        for (std::size_t k = 0; k < first_ring; ++k)
            found.insert(found.end(), near_.begin() + first_[found[k]], near_.begin() + first_[found[k] + 1]);
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        found.erase(std::remove(found.begin(), found.end(), i), found.end());
        return found;
    }

  private:
    static Vec3 three(std::span<const float> values, std::uint32_t i) {
        return {double(values[3 * i]), double(values[3 * i + 1]), double(values[3 * i + 2])};
    }

    void join_vertices() {
        std::map<std::array<float, 8>, std::uint32_t> seen;
        for (std::uint32_t i = 0; i < same_.size(); ++i) {
            const float *p = &mesh_.positions[3 * i], *n = &mesh_.normals[3 * i], *uv = &mesh_.uvs[2 * i];
            same_[i] = seen.try_emplace({p[0], p[1], p[2], n[0], n[1], n[2], uv[0], uv[1]}, i).first->second;
        }
    }

    void sum_directions() {
        means_.resize(same_.size());
        for (std::size_t i = 0; i + 2 < mesh_.indices.size(); i += 3) {
            const std::uint32_t* corner = &mesh_.indices[i];
            const Vec3 p = position(corner[1]) - position(corner[0]), q = position(corner[2]) - position(corner[0]);
            const Vec2 a = uv(corner[1]) - uv(corner[0]), b = uv(corner[2]) - uv(corner[0]);
            const double area = cross(a, b), side = area < 0.0 ? -1.0 : 1.0;
            for (std::size_t k = 0; k < 3; ++k) {
                Mean& mean = means_[same_[corner[k]]];
                mean.du = mean.du + (p * b.y - q * a.y) * side;
                mean.dv = mean.dv + (q * a.x - p * b.x) * side;
                mean.area += std::abs(area);
            }
        }
    }

    // An edge of one triangle only is a border of its chart.
    void count_borders(std::vector<std::pair<std::uint32_t, std::uint32_t>> edges) {
        border_.assign(same_.size(), false);
        for (auto& edge : edges) edge = std::minmax(edge.first, edge.second);
        std::sort(edges.begin(), edges.end());
        for (std::size_t i = 0, next = 0; i < edges.size(); i = next) {
            while (next < edges.size() && edges[next] == edges[i]) ++next;
            if (next - i <= 2) border_[edges[i].first] = border_[edges[i].second] = true;
        }
    }

    struct Mean {
        Vec3 du{}, dv{};
        double area = 0.0;
    };
    const SurfaceMesh& mesh_;
    std::vector<Mean> means_;
    std::vector<std::uint32_t> same_, near_;
    std::vector<std::ptrdiff_t> first_;
    std::vector<bool> border_;
};

// What one neighbour says: the way to it in uv, scaled to about 1, and in space; its normal.
struct Witness {
    double a, b;
    Vec3 way, normal;
    double weight;
};

std::vector<Witness> witnesses(const Neighbourhood& mesh, std::uint32_t i, double crease_cosine, Vec2& scale) {
    std::vector<Witness> found;
    const Vec3 p = mesh.position(i), n = mesh.normal(i);
    for (const std::uint32_t j : mesh.around(i)) {
        const Vec2 uv = mesh.uv(j) - mesh.uv(i);
        const Vec3 way = mesh.position(j) - p;
        const double square = dot3(way, way);
        if (!(square > 0.0) || dot3(n, mesh.normal(j)) < crease_cosine) continue;
        found.push_back({uv.x, uv.y, way, mesh.normal(j), 1.0 / square});
        scale.x = std::max(scale.x, std::abs(uv.x));
        scale.y = std::max(scale.y, std::abs(uv.y));
    }
    for (Witness& w : found) w.a /= scale.x, w.b /= scale.y;
    return found;
}

// Derivatives of the position: du, dv, duu, duv, dvv in scaled uv.
std::array<Vec3, 5> fit_positions(const std::vector<Witness>& all) {
    LeastSquares<5, 3> fit;
    for (const Witness& w : all)
        fit.add({w.a, w.b, 0.5 * w.a * w.a, w.a * w.b, 0.5 * w.b * w.b}, w.way, w.weight);
    return fit.solve(2);
}

// The curvature duu . N, duv . N, dvv . N in scaled uv: from heights over the tangent plane, seen from both ends of an
// edge, and from the lean of the normals. Even two neighbours determine it.
Vec3 fit_curvature(const std::vector<Witness>& all, const Vec3& n, const Vec3& du, const Vec3& dv) {
    LeastSquares<3, 1> fit;
    for (const Witness& w : all) {
        const double height = 0.5 * (dot3(w.way, n) - dot3(w.way, w.normal));
        fit.add({0.5 * w.a * w.a, w.a * w.b, 0.5 * w.b * w.b}, {height}, w.weight);
        fit.add({w.a, w.b, 0.0}, {-dot3(w.normal, du)}, 0.25 * w.weight);
        fit.add({0.0, w.a, w.b}, {-dot3(w.normal, dv)}, 0.25 * w.weight);
    }
    const auto h = fit.solve(0);
    return {h[0][0], h[1][0], h[2][0]};
}

std::array<float, 3> stored(const Vec3& v) {
    const bool finite = std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
    return finite ? std::array{float(v[0]), float(v[1]), float(v[2])} : std::array{0.0f, 0.0f, 0.0f};
}

// Whether what was fitted is about what the triangles around say.
bool agree(const Vec3& fitted, const Vec3& mean) {
    const Vec3 off = fitted - mean;
    return dot3(off, off) < 0.25 * dot3(mean, mean);
}

// `change`: how much the first derivatives vary from here to the neighbours, part of their length.
SurfaceFrame frame_at(const Neighbourhood& mesh, std::uint32_t i, const FrameOptions& options, double& change) {
    const Vec3 n = mesh.normal(i);
    const Vec3 mean_du = mesh.mean_du(i) - n * dot3(mesh.mean_du(i), n), mean_dv = mesh.mean_dv(i) - n * dot3(mesh.mean_dv(i), n);
    Vec2 scale{1e-30, 1e-30};
    const std::vector<Witness> all = witnesses(mesh, i, options.crease_cosine, scale);
    const SurfaceFrame mean{stored(mean_du), stored(mean_dv), {}, {}, {}};
    if (all.size() < 2) return mean;
    std::array<Vec3, 5> d = fit_positions(all);
    for (Vec3& v : d) v = v - n * dot3(v, n);
    if (!agree(d[0] * (1.0 / scale.x), mean_du) || !agree(d[1] * (1.0 / scale.y), mean_dv)) return mean;
    const Vec3 h = fit_curvature(all, n, d[0], d[1]);
    for (std::size_t k = 0; k < 3; ++k) d[2 + k] = d[2 + k] + n * h[k];
    const double first = std::max({length3(d[0]), length3(d[1]), 1e-300});
    for (std::size_t k = 2; k < 5; ++k) change = std::max(change, length3(d[k]) / first);
    return {stored(d[0] * (1.0 / scale.x)), stored(d[1] * (1.0 / scale.y)), stored(d[2] * (1.0 / (scale.x * scale.x))),
            stored(d[3] * (1.0 / (scale.x * scale.y))), stored(d[4] * (1.0 / (scale.y * scale.y)))};
}

}  // namespace

std::vector<SurfaceFrame> compute_frames(const SurfaceMesh& mesh, const FrameOptions& options) {
    const std::size_t count = mesh.positions.size() / 3;
    assert(mesh.normals.size() == mesh.positions.size() && mesh.uvs.size() == 2 * count);
    const Neighbourhood around(mesh);
    std::vector<SurfaceFrame> frames(count);
    double change = 0.0;
    for (std::uint32_t i = 0; i < count; ++i)
        frames[i] = around.joined(i) == i ? frame_at(around, i, options, change) : frames[around.joined(i)];
    if (change <= options.flat) frames.clear();
    return frames;
}

}  // namespace burin
