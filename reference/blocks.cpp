#include "blocks.hpp"

#include <algorithm>

namespace burin::reference {
namespace {

// 12 to 32 MB.
constexpr std::size_t kMostWeight = 20000, kWeightOfBlock = 8;

void put_face(LocalGeometry& geometry, Face face, Polygon polygon) {
    if (!polygon) return;
    face.polygon = polygon;
    face.box = {};
    for (const Vec3* p = geometry.points.begin(polygon); p != geometry.points.end(polygon); ++p) include(face.box, plan(*p));
    geometry.faces.push_back(face);
}

Polygon clip_to(Polygons<Vec3>& points, Polygon p, const Box& box) {
    for (const HalfSpace& side : {HalfSpace{{-1, 0, 0}, -box.low.x}, HalfSpace{{0, -1, 0}, -box.low.y}, HalfSpace{{1, 0, 0}, box.high.x}, HalfSpace{{0, 1, 0}, box.high.y}})
        if (p) p = points.clip(p, side);
    return p;
}

Extents extents_of(const LocalGeometry& geometry, const Face& face) {
    Extents out{face.box, 1e300, -1e300};
    for (const Vec3* p = geometry.points.begin(face.polygon); p != geometry.points.end(face.polygon); ++p)
        out.lowest = std::min(out.lowest, p->z), out.highest = std::max(out.highest, p->z);
    return out;
}

// Calls use(square) for those that the box meets.
template <typename Use>
void for_each_square(const Block& block, const Box& box, const Use& use) {
    const auto inside = [&](std::int64_t i) { return std::clamp<std::int64_t>(i, 0, block.squares - 1); };
    for (std::int64_t j = inside(block.lattice.row(box.low.y)); j <= inside(block.lattice.row(box.high.y)); ++j)
        for (std::int64_t i = inside(block.lattice.column(box.low.x)); i <= inside(block.lattice.column(box.high.x)); ++i)
            use(static_cast<std::size_t>(j * block.squares + i));
}

// Some faces to a square.
void divide(Block& block) {
    block.squares = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::sqrt(0.25 * double(block.geometry.faces.size()))), 1, 16);
    block.lattice = {block.box.low, (block.box.high.x - block.box.low.x) / double(block.squares)};
}

// What of the faces lies in the block. The ground reaches under everything: by squares it is carved by what lies there alone.
void clip_faces(Block& block) {
    LocalGeometry& geometry = block.geometry;
    const std::vector<Face> faces = std::move(geometry.faces);
    geometry.faces.clear();
    for (const Face& face : faces) {
        Polygon rest = clip_to(geometry.points, face.polygon, block.box);
        if (face.kind != FaceKind::ground || face.wall) {
            put_face(geometry, face, rest);
            continue;
        }
        for (std::int64_t j = 1; j <= block.squares; ++j) {
            Polygon row, square;
            geometry.points.split(rest, HalfSpace{{0, 1, 0}, block.lattice.start.y + double(j) * block.lattice.side}, row, rest);
            for (std::int64_t i = 1; i <= block.squares; ++i) {
                geometry.points.split(row, HalfSpace{{1, 0, 0}, block.lattice.start.x + double(i) * block.lattice.side}, square, row);
                put_face(geometry, face, square);
            }
        }
    }
}

void list_faces(Block& block) {
    const auto& faces = block.geometry.faces;
    block.first.assign(static_cast<std::size_t>(block.squares * block.squares) + 1, 0);
    for (const Face& face : faces) for_each_square(block, face.box, [&](std::size_t square) { ++block.first[square]; });
    std::uint32_t listed = 0;
    for (std::uint32_t& entry : block.first) listed += entry, entry = listed;
    block.listed.resize(listed);
    for (std::uint32_t i = 0; i < faces.size(); ++i)
        for_each_square(block, faces[i].box, [&](std::size_t square) { block.listed[--block.first[square]] = i; });
    block.asked.assign(faces.size(), 0);
}

}  // namespace

void Blocks::choose(const GroovedSurface& surface, double width, double reach, double tolerance) {
    if (weight_ > kMostWeight) layers_.clear(), weight_ = 0;
    surface_ = &surface;
    // Some elements, some pixels: what a block shows to many footprints is made once, but for its border.
    const double side = std::max(std::clamp(2.0 * surface.spacing(), 5.0 * width, 16.0 * width), 0.06 * reach);
    const int side_level = static_cast<int>(std::floor(std::log2(side))), level = static_cast<int>(std::lround(2.0 * std::log2(tolerance)));
    layer_ = &layers_[{surface.id(), side_level, level}];
    const double length_of_side = std::ldexp(1.0, side_level);
    // Not where patterns have their lines.
    layer_->lattice = {Vec2{0.3819660113, 0.2763932023} * length_of_side, length_of_side};
    layer_->tolerance = std::exp2(0.5 * level);
}

Block& Blocks::block_at(std::int64_t column, std::int64_t row) {
    std::unique_ptr<Block>& place = layer_->blocks[static_cast<std::uint64_t>(column) << 32 ^ static_cast<std::uint64_t>(row & 0xffffffff)];
    if (place) return *place;
    weight_ += kWeightOfBlock;
    place = std::make_unique<Block>();
    const Lattice& lattice = layer_->lattice;
    const Vec2 low = lattice.start + Vec2{double(column), double(row)} * lattice.side;
    place->box = {low, low + Vec2{lattice.side, lattice.side}};
    const Box& box = place->box;
    Footprint whole;
    for (const Vec2 corner : {box.low, Vec2{box.high.x, box.low.y}, box.high, Vec2{box.low.x, box.high.y}}) whole.corners.push_back(corner);
    gather_grooves(*surface_, whole, {}, place->gathered);
    return *place;
}

void Blocks::open(Block& block) {
    sweep_grooves(*surface_, block.gathered, {layer_->tolerance}, block.geometry);
    divide(block);
    clip_faces(block);
    for (const Face& face : block.geometry.faces) block.extents.push_back(extents_of(block.geometry, face));
    list_faces(block);
    weight_ += block.geometry.faces.size();
    block.carver.emplace(block.geometry, *surface_, block.gathered, block.carving);
}

}  // namespace burin::reference
