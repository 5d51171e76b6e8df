// Tiles and bricks: plateaus with bevels between joints, or joints cut as grooves.
#include <algorithm>
#include <array>
#include <cmath>

#include "generate_internal.hpp"

namespace burin::generating {
namespace {

// By how much of what a joint leaves between two bevels a corner may stray: less than half of it, so that they stay apart.
constexpr double kFarthestStray = 0.45;

// A block that fills a cell of the wall; corners clockwise on screen, from the upper left one.
using Corners = std::array<Vec2, 4>;

Path outline(const Corners& corners, double radius, std::uint32_t profile) {
    Path path;
    path.profile = profile;
    path.closed = true;
    std::array<Vec2, 4> before, after;  // where the rounding of a corner begins and ends
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2 back = corners[(i + 3) % 4] - corners[i], ahead = corners[(i + 1) % 4] - corners[i];
        before[i] = corners[i] + back * (radius / steady::distance(back));
        after[i] = corners[i] + ahead * (radius / steady::distance(ahead));
    }
    for (std::size_t i = 0; i < 4; ++i) {
        path.elements.push_back(straight(after[i], before[(i + 1) % 4]));
        if (radius > 0.0) path.elements.push_back(bent(before[(i + 1) % 4], corners[(i + 1) % 4], after[(i + 1) % 4]));
    }
    return path;
}

// Blocks of a wall, cell by cell.
class Mason {
  public:
    Mason(Work& work, std::uint32_t profile)
        : work_(work), profile_(profile), joint_(work.value("joint")), depth_(work.value("depth")), round_(work.value("round")),
          uneven_(work.value("uneven")), stray_(work.value("irregular") * kFarthestStray * (joint_ - work.value("bevel"))), chance_(work.spec.seed) {}

    Status lay(Vec2 low, Vec2 high) {
        const Vec2 room = high - low;
        const double need = joint_ + 2.0 * (stray_ + std::max(round_, 0.5 * work_.value("bevel")));
        if (std::min(room.x, room.y) <= 1.05 * need)
            return refuse(work_, "blocks of " + parameter_text(room.x) + " by " + parameter_text(room.y) + " m have no room for joint, bevel and round corners; they need " +
                                     parameter_text(1.05 * need) + " m");
        const double h = 0.5 * joint_;
        Corners corners = {Vec2{low.x + h, low.y + h}, Vec2{high.x - h, low.y + h}, Vec2{high.x - h, high.y - h}, Vec2{low.x + h, high.y - h}};
        for (Vec2& corner : corners) {
            corner.x += stray_ * chance_.between(-1.0, 1.0);
            corner.y += stray_ * chance_.between(-1.0, 1.0);
        }
        Path path = outline(corners, round_, profile_);
        path.level = -depth_;
        const double height = 1.0 - uneven_ * chance_.uniform();
        for (Element& e : path.elements) e.height0 = e.height1 = height;
        work_.pattern.paths.push_back(std::move(path));
        return Done{};
    }

  private:
    Work& work_;
    std::uint32_t profile_;
    double joint_, depth_, round_, uneven_, stray_;
    Chance chance_;
};

// Joints as grooves: courses all along, and the joints between the blocks of a course from one to the next.
Status cut_joints(Work& work, int rows, int columns, double shift) {
    const auto profile = work.add_section(work.value("joint"), -work.value("depth"));
    if (!profile) return profile.error();
    const Vec2 size = work.pattern.size, block{size.x / columns, size.y / rows};
    const bool repeats = work.repeats();
    for (int row = 0; row < rows; ++row) {
        const double y = block.y * row;
        Path course;
        course.profile = *profile;
        course.elements = {straight({0.0, y}, {size.x, y})};
        course.closed = repeats;
        if (repeats || row > 0) work.pattern.paths.push_back(course);
        const double offset = shift * (row % 2);
        for (int column = 0; column < columns; ++column) {
            const double x = block.x * (column + offset);
            if (!repeats && x == 0.0) continue;
            Path joint;
            joint.profile = *profile;
            joint.elements = {straight({x, y}, {x, y + block.y})};
            work.pattern.paths.push_back(joint);
        }
    }
    return Done{};
}

Status lay_wall(Work& work, int rows, int columns, double shift) {
    if (work.count("raised") == 0) return cut_joints(work, rows, columns, shift);
    if (work.value("bevel") > work.value("joint"))
        return refuse(work, "bevel " + parameter_text(work.value("bevel")) + " is wider than joint " + parameter_text(work.value("joint")));
    const auto profile = work.add_step(work.value("bevel"), work.value("depth"));
    if (!profile) return profile.error();
    work.pattern.outer_level = -work.value("depth");
    Mason mason(work, *profile);
    const Vec2 size = work.pattern.size, block{size.x / columns, size.y / rows};
    for (int row = 0; row < rows; ++row) {
        const double y = block.y * row, offset = block.x * shift * (row % 2);
        // A clamped wall ends its courses with the parts of a block.
        const bool cut = !work.repeats() && offset > 0.0;
        for (int column = cut ? -1 : 0; column < columns; ++column) {
            const double left = block.x * column + offset, right = left + block.x;
            const double low = cut ? std::max(left, 0.0) : left, high = cut ? std::min(right, size.x) : right;
            if (const Status laid = mason.lay({low, y}, {high, y + block.y}); !laid) return laid;
        }
    }
    return Done{};
}

}  // namespace

Status make_tiles(Work& work) { return lay_wall(work, work.count("rows"), work.count("columns"), 0.0); }

// An even number of courses, so that shifted ones alternate over the border.
Status make_bricks(Work& work) { return lay_wall(work, 2 * work.count("course_pairs"), work.count("columns"), work.value("shift")); }

}  // namespace burin::generating
