// What of the faces is the surface: all additions before any subtraction. [2008] 6.2, DESIGN 2
//
//     LocalGeometry --[Carver]--> pieces of faces
//
// A face of the ground or of an addition is lost where it lies inside an addition of another element, or in any cut; a
// face of a cut is lost in another element's cut, and where there was nothing to cut. Of faces that coincide the one of the
// element that comes first stays, and the ground's before all, as the truth has it.
#pragma once

#include "sweep.hpp"

namespace burin::reference {

// A part of a face, and its box in plan.
struct Part {
    Polygon polygon;  // in LocalGeometry::points
    Box box;
};

// Memory of one thread, used again and again.
struct Carving {
    struct Pieces {
        std::uint32_t first = 0, count = 0;
        bool carved = false;
    };
    std::vector<Part> pieces;
    std::vector<Pieces> of_face;
    std::vector<HalfSpace> halves;          // of all brushes
    std::vector<std::uint32_t> first_half;  // of each brush, and one past the last
    std::vector<Part> kept, next, solid;
    // Brushes by the cells of the region, row by row, that their boxes meet: a range of `binned` for each.
    std::vector<std::uint32_t> first_binned, binned;
    std::vector<std::uint32_t> asked;       // of each brush: for which face it was last found
    std::vector<std::uint32_t> candidates;  // brushes whose boxes meet the face at hand and that it does not belong to, ascending
    std::uint32_t turn = 0;
};

// Carves a face when it is first asked for: most are neither seen nor throw a shadow. All must outlive it.
class Carver {
  public:
    Carver(LocalGeometry& geometry, const GroovedSurface& surface, const Gathered& gathered, Carving& work);

    const LocalGeometry& geometry() const { return geometry_; }
    const Gathered& gathered() const { return gathered_; }
    // What is left of a face, as a range of Carving::pieces. Cost: the brushes whose boxes meet its own.
    Carving::Pieces pieces_of(std::uint32_t face);
    const Part& piece(std::uint32_t index) const { return work_.pieces[index]; }

  private:
    void sort_brushes();
    template <typename Use>
    void for_each_cell(const Box& box, const Use& use) const;
    void find_candidates(const Face& face);
    void carve(const Face& face);
    void carve_ground(Polygon polygon, const Face& face, const std::vector<std::uint32_t>& candidates, int depth);
    void keep_first_wall(const Face& face);
    void keep(Polygon p);
    bool overhangs(std::uint32_t instance) const;
    bool spares(const Face& face, const Brush& brush) const;
    double tie(const Face& face, const Brush& brush) const;
    void keep_solid(const Face& face);
    void remove(const Face& face, std::size_t brush, double grow);
    Vec2 judged_at(const Face& face, const Brush& brush) const;
    HalfSpace half_of(const Face& face, std::size_t index, std::uint32_t k, double grow) const;
    bool misses(const Face& face, const Part& part, std::size_t index, double grow) const;
    Polygon subtract(const Face& face, const Part& part, std::size_t index, double grow);
    bool all_beyond(Polygon p, const HalfSpace& half) const;
    Part part_of(Polygon p) const;

    LocalGeometry& geometry_;
    const GroovedSurface& surface_;
    const Gathered& gathered_;
    Carving& work_;
    int columns_ = 1, rows_ = 1;  // of cells
};

}  // namespace burin::reference
