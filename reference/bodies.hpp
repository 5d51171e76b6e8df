// Rays against the mesh of an asset: where beams go that leave the grooves. [2008] 7
#pragma once

#include <memory>
#include <optional>

#include "scene.hpp"

namespace burin::reference {

// Never changes once made; safe to ask from several threads.
class Bodies {
  public:
    // Cost: n log n for n triangles. Keeps a reference to nothing.
    explicit Bodies(const Asset& asset);
    ~Bodies();
    Bodies(Bodies&&) noexcept;

    // The first triangle that stops a ray in the open, one that it comes to from outside; or one within glass: the glass's other side, or anything else.
    std::optional<MeshPoint> first_hit(const glm::dvec3& from, const glm::dvec3& direction, bool within) const;

  private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace burin::reference
