// A mesh that rays are traced through by Embree: the judge of hits on bent surfaces.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <embree3/rtcore.h>

#include "surfaces.hpp"

namespace burin::testing {

struct EmbreeHit {
    double distance;  // infinity: none
    std::uint32_t triangle;
    double u, v;
};

// One mesh in Embree; rays may be traced from several threads.
class EmbreeScene {
  public:
    EmbreeScene(const std::vector<float>& positions, const std::vector<std::uint32_t>& indices)
        : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* vertices = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, positions.size() / 3);
        std::copy(positions.begin(), positions.end(), static_cast<float*>(vertices));
        void* corners = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, indices.size() / 3);
        std::copy(indices.begin(), indices.end(), static_cast<std::uint32_t*>(corners));
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene_, mesh);
        rtcReleaseGeometry(mesh);
        rtcCommitScene(scene_);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    ~EmbreeScene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    EmbreeHit trace(const Vec3& origin, const Vec3& direction, double near) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit ray{};
        ray.ray.org_x = float(origin[0]), ray.ray.org_y = float(origin[1]), ray.ray.org_z = float(origin[2]);
        ray.ray.dir_x = float(direction[0]), ray.ray.dir_y = float(direction[1]), ray.ray.dir_z = float(direction[2]);
        ray.ray.tnear = float(near), ray.ray.tfar = HUGE_VALF, ray.ray.mask = ~0u;
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &ray);
        const bool hit = ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        return {hit ? double(ray.ray.tfar) : HUGE_VAL, ray.hit.primID, double(ray.hit.u), double(ray.hit.v)};
    }

  private:
    RTCDevice device_;
    RTCScene scene_;
};

}  // namespace burin::testing
