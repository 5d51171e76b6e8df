// The recursive footprint: what a facet shows is a footprint of its own, seen along the direction that light is mirrored, scattered
// or bent from. [2008] 7
//
//     footprint of a place --[find_seen]--> shares --[color_of]--> facets' own light
//                                                  └▶ beams ─▶ other facets ─▶ again
//                                                          └▶ out of the relief ─▶ the mesh's next place ─▶ its footprint ─▶ again, or the surround
//
// Glass parts a beam in two at each facet, one that is mirrored and one that is bent. Below the relief the bent one runs through the body to the mesh's
// other side, whose pattern it sees from behind. A mesh without another side is a sheet: it has a flat one.
#pragma once

#include <vector>

#include "bodies.hpp"
#include "environment.hpp"
#include "render.hpp"
#include "scene.hpp"

namespace burin::reference {

// How a beam has come.
struct Path {
    std::size_t level = 0;   // facets before
    double weight = 1.0;     // about what part of the pixel's light comes this way
    double width = 0.0;      // of a pixel, metres
    double solid = 0.0;      // steradians that it stands for
    bool through = false;    // glass
    glm::dvec3 from{0.0};    // where it left the last facet, world
};

// What is met at one level.
struct Level {
    Footprint footprint;
    AreasWork areas;
    std::vector<Share> shares;
    std::vector<Scattered> scattered;
    Beam beam;
};

// Memory of one thread.
struct BeamWork {
    std::vector<Level> levels;  // from the eye on
    std::uint64_t seed = 0;
    double cut_off = 0.0;       // weight of the paths that glass was not followed along to the end
};

// Never changes once made; safe to ask from several threads.
class BeamTracer {
  public:
    // All must outlive it.
    BeamTracer(const Scene& scene, const ReferenceOptions& options);

    std::size_t levels() const { return most_ + 1; }
    // Fills the shares of a level from its footprint, which lies in the plane of the place.
    void find_seen(const Place& place, std::size_t level, double width, BeamWork& work) const;
    // Light of the level's shares towards where they are seen from, each as far as it is seen.
    glm::dvec3 color_of(const Place& place, const Path& path, BeamWork& work) const;

  private:
    bool follows(const Paint& paint) const { return most_opaque_ > 0 || paint.is_glass(); }
    std::size_t most_for(const Paint& paint) const;
    AreasOptions areas_of(const Place& place, double width) const;
    Slopes slopes_of(const Place& place) const;
    glm::dvec3 own_light(const Place& place, const Share& share, const Path& path) const;
    glm::dvec3 followed_light(const Place& place, const Share& share, const Path& path, BeamWork& work) const;
    glm::dvec3 facet_color(const Place& place, const Paint& paint, const glm::dvec3& normal, double lit) const;
    glm::dvec3 light_by_way(const Place& place, const Share& share, const Paint& paint, const glm::dvec3& normal, const Path& path, BeamWork& work) const;
    glm::dvec3 light_along(const Place& place, const Path& path, const glm::dvec3& direction, BeamWork& work) const;
    glm::dvec3 light_from_beyond(const Place& place, const Path& path, const glm::dvec3& direction, BeamWork& work) const;
    glm::dvec3 light_of_surround(const Path& path, const glm::dvec3& direction) const;
    glm::dvec3 kept_within(const Place& place, const Share& share, const Path& path) const;

    const Scene& scene_;
    const ReferenceOptions& options_;
    Bodies bodies_;
    std::optional<EnvironmentLight> environment_;
    glm::dvec3 light_, background_;
    std::size_t most_opaque_ = 0, most_ = 0;  // levels after which none is followed: of what is no glass, of all
};

}  // namespace burin::reference
