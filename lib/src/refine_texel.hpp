// The mean of the model over one texel, and how it changes with the features that shape it.
//
// A texel is divided into four, and each part again, until one feature plainly rules the part: then its mean is known
// in closed form. Who rules is told by bounds: within a square every feature's height lies between two numbers, and a
// feature that stays below another's least height (above another's greatest, where they cut) has no say there. The same
// bounds thin out the list of a whole tile first, so that texels under many wide, overlapping profiles look at few.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "refine_forward.hpp"
#include "refine_scene.hpp"

namespace burin::refinement {

// How many local quantities a feature has: see kPoints.
inline int local_count(const Feature& feature) { return kProfile + 2 * static_cast<int>(feature.profile->b.size()); }

// A feature near the texel.
struct Candidate {
    std::uint32_t instance = 0;
    const Feature* feature = nullptr;
    bool used = false;
    std::array<double, kMaxLocal> local;  // derivatives of the texel's mean; valid when used
};

class TexelModel {
  public:
    TexelModel(const Layout& layout, const ForwardOptions& options, bool derivatives);

    // Gathers what may act near texel (x, y). False when nothing is near. Texels of one tile in a row are cheapest.
    bool gather(int x, int y);

    // Mean of the model over the texel; with derivatives in the candidates that shape it.
    double mean();

    std::size_t count() const { return count_; }
    Candidate& candidate(std::size_t i) { return candidates_[i]; }

  private:
    struct Square {
        Vec2 centre, side;
        double half = 0.0;   // of the diagonal
        double share = 1.0;  // of the texel
    };

    // A feature in a square.
    struct Actor {
        std::uint32_t instance = 0;
        int candidate = -1;
        const Feature* feature = nullptr;
        Vec2 offset;
        Foot foot;  // of the square's centre
        Reach reach;
        double low = 0.0, high = 0.0;  // its heights in the square lie between
        bool left = true, right = true;        // sides of its line that the square may touch
        bool within = false;                   // the square lies between the ends of its profile
        bool may_cut = true, must_cut = false;
        // Its height over the square is a plane, up to `slack`.
        bool plane = false;
        double middle = 0.0, slack = 0.0;
        Vec2 slope;
        bool ruler = false;  // its height counts everywhere in the square
    };

    // A feature that may act in the tile.
    struct Listed {
        std::uint32_t instance = 0;
        double guess = -1.0;  // see foot_of
    };

    // What stands in a square where no other feature has a say: the ground, or the nearest step.
    struct Base {
        double low = 0.0, high = 0.0;
        double level = 0.0;  // of the ground, when known
        bool known = false;  // one ground in the whole square
        int step = -1;       // the one step that is nearest everywhere, as an index into the actors
    };

    // Between which heights the surface stays, by the features that act in all of a square.
    struct Limits {
        double floor = 0.0, ceiling = 1e300;  // no lower before cuts; no higher after them
        double upper = 0.0;                   // no higher before cuts
        int highest = -1, lowest = -1;        // whose floor and ceiling: a candidate
    };

    // One feature's say in one cell.
    struct Say {
        Placement placement;
        Spread spread;
        double width = 1.0, height = 1.0;  // scales
        double b = 0.0;                    // on the profile
        double value = 0.0;
        bool cuts = false;
    };

    void enter_tile(std::size_t tile, int column, int row);
    bool has_one_ground(std::size_t tile, int column, int row);
    bool rules_tile(const Actor& actor, std::size_t tile, int column, int row, double radius);
    bool gather_lone();
    double lone_mean(const Actor& actor);
    double lone_cell(const Actor& actor, const Square& cell);
    void consider(const Listed& listed, const Square& texel);
    Actor actor_of(std::uint32_t index) const;
    void bound(Actor& actor, double radius) const;
    void descend(int depth, const Square& part);
    Base base_of(const std::vector<Actor>& actors, const std::vector<StepLine>& steps) const;
    bool rules(const Actor& actor, const Base& base) const;
    Limits limits_of(const std::vector<Actor>& actors, const Base& base) const;
    void cull(std::vector<Actor>& actors, const std::vector<StepLine>& steps, double half) const;
    static bool clears(const Actor& a, const Actor& b, double sign, double half);
    static bool outdone(const Actor& a, const Actor& r, double half);
    bool settled(const std::vector<Actor>& actors, const std::vector<StepLine>& steps, const Square& square,
                 int depth) const;
    double doubt(const std::vector<Actor>& actors, const std::vector<StepLine>& steps) const;
    double discord(const std::vector<Actor>& actors, const std::vector<StepLine>& steps, double half) const;
    bool joined_smoothly(const std::vector<Actor>& actors) const;
    bool ruled_by_one();
    double square_mean(const Square& square, int depth);
    double cell_mean(const Square& cell, int depth, bool derivatives);
    bool speak(const Actor& actor, const Square& cell, Say& say) const;
    bool say_of(const Actor& actor, const Square& cell, double ground, bool any_level, Say& say) const;
    int nearest_actor(const Square& cell, int depth, double& ground) const;
    // Adds the derivatives of a cell's mean to the candidate's; returns the mean.
    double differentiate(Candidate& candidate, const Say& say, double share);
    void differentiate_ground(double ground, double share);

    static constexpr int kDepths = 5;

    const Layout& layout_;
    const int divisions_;
    const double precision_;
    const bool derivatives_;
    int most_divisions_ = 1;
    std::vector<Listed> tile_list_;
    const std::vector<StepLine>* tile_steps_ = nullptr;
    std::vector<Candidate> candidates_;
    std::size_t count_ = 0;
    // By depth: 0 is the texel, each next one a quarter of the one before.
    std::array<std::vector<Actor>, kDepths> actors_;
    std::array<std::vector<StepLine>, kDepths> steps_;
    std::vector<Actor> tile_actors_;
    std::vector<Say> says_;
    std::vector<std::uint8_t> spoke_;
    std::size_t tile_ = ~std::size_t{0};
    Square texel_;
    double ground_ = 0.0;
    bool near_step_ = false;
    bool lone_ = false;  // one feature plainly rules the whole tile
    int winner_ = -1;  // of the last cell: a candidate, -1 for the ground
};

}  // namespace burin::refinement
