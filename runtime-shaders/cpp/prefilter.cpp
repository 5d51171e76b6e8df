#include "cpp/prefilter.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace burin {
namespace {

// A short straight piece of an element.
struct Piece {
    Vec2 place;  // uv
    int direction = 0;
    std::uint32_t style = 0;
    double weight = 0.0;  // metres times width scale
    double height = 1.0;
};

using Kind = std::pair<std::uint32_t, int>;  // style and direction

Vec2 point_of(const ElementCode& element, double s) {
    const Vec2 a{decode_coordinate(element.p0.u), decode_coordinate(element.p0.v)};
    const Vec2 c{decode_coordinate(element.p2.u), decode_coordinate(element.p2.v)};
    if (!element.quadratic) return a + (c - a) * s;
    const Vec2 b{decode_coordinate(element.p1.u), decode_coordinate(element.p1.v)};
    return a * ((1 - s) * (1 - s)) + b * (2 * s * (1 - s)) + c * (s * s);
}

double scale_of(const ElementCode& element, std::uint32_t from, std::uint32_t to, double s) {
    if (!element.has_texel_b) return 1.0;
    return decode_scale(from) * (1.0 - s) + decode_scale(to) * s;
}

// Pieces no longer than a third of a block; an element wider than long still counts by its path.
void cut_element(const ElementCode& element, Vec2 size, Vec2 block, std::vector<Piece>& pieces) {
    const Vec2 chord = point_of(element, 1.0) - point_of(element, 0.0);
    const double blocks = std::max(std::abs(chord.x) / block.x, std::abs(chord.y) / block.y);
    const int count = std::clamp(int(std::ceil(blocks * 3.0)), element.quadratic ? 6 : 1, 4096);
    for (int i = 0; i < count; ++i) {
        const double s = (i + 0.5) / count;
        const Vec2 step = point_of(element, (i + 1.0) / count) - point_of(element, double(i) / count);
        const Vec2 metres{step.x * size.x, step.y * size.y};
        const double turns = std::atan2(metres.y, metres.x) / (2.0 * std::numbers::pi) * Prefilter::kDirections;
        Piece piece;
        piece.place = point_of(element, s);
        piece.direction = (int(std::lround(turns)) + Prefilter::kDirections) % Prefilter::kDirections;
        piece.style = element.style;
        piece.weight = length(metres) * scale_of(element, element.width0, element.width1, s);
        piece.height = scale_of(element, element.height0, element.height1, s);
        pieces.push_back(piece);
    }
}

std::vector<Piece> cut_elements(const PackedTextures& textures, const PathDetail& detail, Vec2 block) {
    std::vector<Piece> pieces;
    // Functions along paths are left out: sine and noise are 1 in the mean.
    for (std::uint32_t k = 0; k < textures.sections.element_texels;) {
        const std::uint32_t count = element_texel_count(data_texel(textures, k));
        if (k + count <= textures.sections.element_texels)
            cut_element(element_at(textures, k), {detail.size_u, detail.size_v}, block, pieces);
        k += count;
    }
    return pieces;
}

struct Sum {
    double weight = 0.0, height = 0.0;
    std::size_t index = 0;
};

double angle_between(int a, int b) {
    const int d = std::abs(a - b);
    return std::min(d, Prefilter::kDirections - d);
}

// The heaviest kinds become classes; the others count as the nearest direction of their style, or of the heaviest one.
std::map<Kind, Sum> choose_classes(const std::vector<Piece>& pieces, std::vector<PrefilterClass>& classes) {
    std::map<Kind, Sum> sums;
    for (const Piece& piece : pieces) {
        Sum& sum = sums[{piece.style, piece.direction}];
        sum.weight += piece.weight;
        sum.height += piece.weight * piece.height;
    }
    std::vector<Kind> order;
    for (const auto& [kind, sum] : sums) order.push_back(kind);
    std::stable_sort(order.begin(), order.end(), [&](Kind a, Kind b) { return sums[a].weight > sums[b].weight; });
    const std::size_t kept = std::min<std::size_t>(order.size(), Prefilter::kMostClasses);
    for (std::size_t i = 0; i < order.size(); ++i) {
        Sum& sum = sums[order[i]];
        if (i < kept) {
            const double turn = 2.0 * std::numbers::pi * order[i].second / Prefilter::kDirections;
            sum.index = i;
            classes.push_back({order[i].first, {std::cos(turn), std::sin(turn)}, sum.height / std::max(sum.weight, 1e-30)});
            continue;
        }
        const auto distance = [&](std::size_t j) {
            return angle_between(order[j].second, order[i].second) + (order[j].first == order[i].first ? 0.0 : 100.0);
        };
        for (std::size_t j = 1; j < kept; ++j)
            if (distance(j) < distance(sum.index)) sum.index = j;
    }
    return sums;
}

// A power of two: only then are the levels above exact means, whoever makes them.
int block_count(int cells) {
    return int(std::bit_floor(unsigned(std::clamp(cells / Prefilter::kCellsPerBlock, 1, 256))));
}

int wrap_block(double at, int count, bool repeat) {
    const int block = int(std::floor(at));
    return repeat ? ((block % count) + count) % count : std::clamp(block, 0, count - 1);
}

}  // namespace

Prefilter prefilter_pattern(const PackedTextures& textures, const PathDetail& detail) {
    Prefilter filter;
    filter.columns = block_count(textures.grid_width);
    filter.rows = block_count(textures.grid_height);
    const std::vector<Piece> pieces = cut_elements(textures, detail, {1.0 / filter.columns, 1.0 / filter.rows});
    const std::map<Kind, Sum> sums = choose_classes(pieces, filter.classes);
    filter.weights.assign(filter.classes.size() * std::size_t(filter.columns) * std::size_t(filter.rows), 0.0f);
    const double area = detail.size_u / filter.columns * detail.size_v / filter.rows;
    for (const Piece& piece : pieces) {
        const Sum& sum = sums.at({piece.style, piece.direction});
        const Texel texel = data_texel(textures, textures.sections.styles_begin() + piece.style);
        const int column = wrap_block(piece.place.x * filter.columns, filter.columns, detail.repeat);
        const int row = wrap_block(piece.place.y * filter.rows, filter.rows, detail.repeat);
        filter.weights[(sum.index * std::size_t(filter.rows) + std::size_t(row)) * std::size_t(filter.columns) +
                       std::size_t(column)] += float(piece.weight / area * double(unpack_style(texel).reach));
    }
    return filter;
}

}  // namespace burin
