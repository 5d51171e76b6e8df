// Every profile that has a name, as the surface it gives and as the text that asks for it.
#include <burin/profiles.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <burin/evaluate.hpp>
#include <burin/grid.hpp>
#include <burin/pack.hpp>
#include <burin/resolve.hpp>

#include "layout.h"

namespace burin {
namespace {

constexpr double kWidth = 0.02, kHeight = 0.006;

// The tile has room for lips and overhangs on both sides of the ground.
Pattern sheet(Profile profile) {
    Pattern pattern;
    pattern.size = {0.2, 0.2};
    pattern.base_offset = 2.0 * kHeight;
    pattern.depth = 4.0 * kHeight;
    pattern.profiles = {std::move(profile)};
    return pattern;
}

Element line(Vec2 from, Vec2 to) {
    Element element;
    element.p0 = from;
    element.p2 = to;
    return element;
}

// Along the whole tile at y = 0.1; offset b is y - 0.1.
Pattern as_line(const Profile& profile) {
    Pattern pattern = sheet(profile);
    Path path;
    path.elements = {line({0.0, 0.1}, {0.2, 0.1})};
    path.closed = true;
    pattern.paths = {path};
    return pattern;
}

// Clockwise on screen, so that the inside is on the right; b = 0 is at y = 0.05 on the upper side, inside below it.
Pattern as_plateau(const Profile& profile) {
    Pattern pattern = sheet(profile);
    const Vec2 corners[] = {{0.05, 0.05}, {0.15, 0.05}, {0.15, 0.15}, {0.05, 0.15}};
    Path path;
    for (int i = 0; i < 4; ++i) path.elements.push_back(line(corners[i], corners[(i + 1) % 4]));
    path.closed = true;
    pattern.paths = {path};
    return pattern;
}

ResolvedPattern resolve_and_pack(const Pattern& pattern, const std::string& what) {
    const auto resolved = resolve_pattern(pattern);
    if (!resolved) {
        ADD_FAILURE() << what << ": " << resolved.error().message;
        return {};
    }
    const auto grid = build_grid(*resolved);
    const bool packed = grid && pack_textures(*resolved, *grid);
    EXPECT_TRUE(packed) << what;
    return *resolved;
}

// Height of the profile's line over b, the topmost or the lowest where it passes there several times.
double line_height(const Profile& profile, double b, bool topmost) {
    double best = topmost ? -1e9 : 1e9;
    for (std::size_t i = 0; i + 1 < profile.points.size(); ++i) {
        const ProfilePoint p = profile.points[i], q = profile.points[i + 1];
        if (p.b == q.b || b < std::min(p.b, q.b) || b > std::max(p.b, q.b)) continue;
        const double h = p.h + (q.h - p.h) * ((b - p.b) / (q.b - p.b));
        best = topmost ? std::max(best, h) : std::min(best, h);
    }
    return best;
}

// Parameters of an entry: the usual ones, all at their low end, and all at their high end.
std::vector<ProfileSpec> specs_of(const ProfileEntry& entry) {
    ProfileSpec low{entry.name, {}}, high{entry.name, {}};
    for (const Parameter& parameter : entry.parameters) {
        low.parameters[parameter.name] = parameter.low;
        high.parameters[parameter.name] = parameter.high;
    }
    return {{entry.name, {}}, low, high};
}

void expect_surface(const Pattern& pattern, double at, double width, double ground_left, double ground_right, const std::string& what) {
    const Truth truth(resolve_and_pack(pattern, what));
    const Profile& profile = pattern.profiles.front();
    const bool undercuts = !profile.facets.empty();
    for (int i = 0; i < 400; ++i) {
        const double b = (i + 0.5) / 400.0 * 2.0 * width - width;
        const bool beside_vertical = std::any_of(profile.points.begin(), profile.points.end(), [&](ProfilePoint p) { return std::abs(p.b - b) < 1e-9; });
        if (beside_vertical) continue;
        double expected = b < 0.0 ? ground_left : ground_right;
        // What is undercut shows its floor only through its mouth.
        const bool covered = undercuts && (b < profile.points.front().b || b > profile.points.back().b);
        double left = 0.0, right = 0.0;
        for (const ProfilePoint& p : profile.points) left = std::min(left, p.b), right = std::max(right, p.b);
        if (!covered && b > left && b < right) expected = line_height(profile, b, !undercuts);
        EXPECT_NEAR(truth.surface_at({0.1, at + b}).height, expected, 1e-12) << what << " at b " << b;
    }
}

TEST(Profiles, every_one_is_the_surface_that_its_points_say) {
    for (const ProfileEntry& entry : profile_table())
        for (const ProfileSpec& spec : specs_of(entry))
            for (const double height : {kHeight, -kHeight}) {
                const std::string what = std::string(entry.name) + (height > 0 ? " up" : " down") + std::to_string(spec.parameters.size());
                const auto section = make_profile(spec, kWidth, height);
                ASSERT_TRUE(section) << what << section.error().message;
                const Pattern pattern = as_line(*section);
                EXPECT_EQ(path_kind(pattern, pattern.paths[0]), height > 0 ? PathKind::ridge : PathKind::groove) << what;
                expect_surface(pattern, 0.1, 1.1 * kWidth, 0.0, 0.0, what);
                const auto step = make_step_profile(spec, kWidth, height);
                ASSERT_TRUE(step) << what << step.error().message;
                const Pattern plateau = as_plateau(*step);
                EXPECT_EQ(path_kind(plateau, plateau.paths[0]), PathKind::step) << what;
                expect_surface(plateau, 0.05, 1.1 * kWidth, 0.0, height, what + " step");
            }
}

TEST(Profiles, sections_are_as_wide_and_high_as_asked) {
    for (const ProfileEntry& entry : profile_table())
        for (const ProfileSpec& spec : specs_of(entry)) {
            const Profile section = *make_profile(spec, kWidth, -kHeight);
            EXPECT_EQ(section.points.front().b, -0.5 * kWidth) << entry.name;
            EXPECT_EQ(section.points.back().b, 0.5 * kWidth) << entry.name;
            EXPECT_EQ(section.points.front().h, 0.0);
            EXPECT_LT(section.points.size(), std::size_t(BURIN_MAX_PROFILE_POINTS)) << entry.name;
            double lowest = 0.0;
            for (const ProfilePoint& p : section.points) lowest = std::min(lowest, p.h);
            EXPECT_DOUBLE_EQ(lowest, -kHeight) << entry.name;
            const Profile step = *make_step_profile(spec, kWidth, kHeight);
            EXPECT_EQ(step.points.front().h, 0.0);
            EXPECT_DOUBLE_EQ(step.points.back().h, kHeight);
            EXPECT_LE(step.points.front().b, 0.0);
            EXPECT_GE(step.points.back().b, 0.0);
        }
}

TEST(Profiles, undercut_is_hollow_under_its_edge) {
    const Pattern pattern = as_line(*make_profile({"overhang", {{"reach", 0.8}, {"foot", 0.5}}}, kWidth, -kHeight));
    const Truth truth(*resolve_pattern(pattern));
    const double beside = 0.1 + 0.5 * kWidth + 0.3 * kWidth;
    EXPECT_TRUE(truth.is_solid({0.1, beside}, -0.25 * kHeight));
    EXPECT_FALSE(truth.is_solid({0.1, beside}, -0.75 * kHeight));
    EXPECT_TRUE(truth.is_solid({0.1, beside}, -1.25 * kHeight));
    const Pattern ridge = as_line(*make_profile({"overhang", {{"reach", 0.8}, {"foot", 0.5}}}, kWidth, kHeight));
    const Truth rail(*resolve_pattern(ridge));
    EXPECT_TRUE(rail.is_solid({0.1, beside}, 0.75 * kHeight));
    EXPECT_FALSE(rail.is_solid({0.1, beside}, 0.25 * kHeight));
}

// Farthest distance of a quarter circle from the polyline; chords of equal angle leave 1 - cos(15 degrees) with four points.
TEST(Profiles, curves_are_better_than_equal_chords) {
    const Profile step = *make_step_profile({"bead", {}}, 1.0, 1.0);
    ASSERT_EQ(step.points.size(), 4u);
    double worst = 0.0;
    for (int i = 0; i <= 1000; ++i) {
        const double angle = 1.5707963267948966 * i / 1000.0;
        const Vec2 p{0.5 - std::cos(angle), std::sin(angle)};
        double nearest = 1.0;
        for (std::size_t k = 0; k + 1 < step.points.size(); ++k) {
            const Vec2 a{step.points[k].b, step.points[k].h}, way = Vec2{step.points[k + 1].b, step.points[k + 1].h} - a;
            nearest = std::min(nearest, length(p - (a + way * std::clamp(dot(p - a, way) / dot(way, way), 0.0, 1.0))));
        }
        worst = std::max(worst, nearest);
    }
    EXPECT_LT(worst, 0.65 * (1.0 - std::cos(0.2617993877991494)));
    EXPECT_GT(worst, 0.45 * (1.0 - std::cos(0.2617993877991494)));
}

TEST(Profiles, slope_decides_the_floor) {
    const Profile section = *make_profile({"flat", {{"slope", 45.0}}}, 0.02, -0.004);
    ASSERT_EQ(section.points.size(), 4u);
    EXPECT_NEAR(section.points[1].b, -0.006, 1e-12);
    const auto narrow = make_profile({"flat", {{"slope", 30.0}}}, 0.002, -0.004);
    ASSERT_FALSE(narrow);
    EXPECT_NE(narrow.error().message.find("a slope of 30 degrees needs a width of 0.0138"), std::string::npos) << narrow.error().message;
}

TEST(Profiles, text_is_name_and_parameters) {
    const auto plain = parse_profile("vee");
    ASSERT_TRUE(plain);
    EXPECT_EQ(plain->name, "vee");
    const auto spec = parse_profile(" flat ( floor = 0.4 ,slope=60) ");
    ASSERT_TRUE(spec) << spec.error().message;
    EXPECT_EQ(spec->name, "flat");
    EXPECT_EQ(spec->parameters, (std::map<std::string, double>{{"floor", 0.4}, {"slope", 60.0}}));
    EXPECT_TRUE(parse_profile("flat()"));
}

TEST(Profiles, refusals_say_what_works) {
    const std::pair<const char*, const char*> cases[] = {
        {"", "profile '' is not known; one of vee, u, flat, bead, cove, ogee, stair, overhang, burr works"},
        {"wedge", "profile 'wedge' is not known; one of vee, u, flat"},
        {"vee(floor=1)", "profile vee: no parameter is called 'floor'; there are none"},
        {"flat(flor=1)", "profile flat: no parameter is called 'flor'; floor, slope work"},
        {"flat(floor=2)", "profile flat: floor 2 is out of its range; 0 to 1 works"},
        {"flat(floor=nan)", "profile flat: 'floor=nan' is not NAME=NUMBER"},
        {"flat(floor)", "profile flat: 'floor' is not NAME=NUMBER"},
        {"flat(floor=0.1,floor=0.2)", "profile flat: floor is given twice"},
        {"flat(floor=0.1,)", "profile flat: '' is not NAME=NUMBER"},
        {"flat(floor=0.1", "does not end in ')'"},
        {"stair(steps=2.5)", "profile stair: steps 2.5 is not a whole number; 2 to 7, whole works"},
    };
    for (const auto& [text, message] : cases) {
        const auto spec = parse_profile(text);
        ASSERT_FALSE(spec) << text;
        EXPECT_EQ(spec.error().code, ErrorCode::invalid_argument);
        EXPECT_NE(spec.error().message.find(message), std::string::npos) << spec.error().message;
    }
    for (const double bad : {0.0, -1.0, double(NAN), double(INFINITY)}) EXPECT_FALSE(make_profile({"vee", {}}, bad, 1.0)) << bad;
    for (const double bad : {0.0, double(NAN), double(INFINITY)}) {
        EXPECT_FALSE(make_profile({"vee", {}}, 1.0, bad)) << bad;
        EXPECT_FALSE(make_step_profile({"vee", {}}, 1.0, bad)) << bad;
    }
    EXPECT_FALSE(make_step_profile({"vee", {}}, -1.0, 1.0));
}

}  // namespace
}  // namespace burin
