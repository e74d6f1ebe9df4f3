// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/ray_caster.h"

#include <array>
#include <cstring>
#include <new>

#include <embree3/rtcore.h>

#include "vdbmap/core/parallel.h"

namespace vdbmap::simulator {
namespace {

template <typename Value>
Value* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Value), count);
  if (buffer == nullptr) throw std::bad_alloc();
  return static_cast<Value*>(buffer);
}

RTCRay embree_ray(const Ray& ray) {
  RTCRay embree{};
  embree.org_x = static_cast<float>(ray.origin.x());
  embree.org_y = static_cast<float>(ray.origin.y());
  embree.org_z = static_cast<float>(ray.origin.z());
  embree.dir_x = static_cast<float>(ray.direction.x());
  embree.dir_y = static_cast<float>(ray.direction.y());
  embree.dir_z = static_cast<float>(ray.direction.z());
  embree.tnear = static_cast<float>(ray.nearest);
  embree.tfar = static_cast<float>(ray.farthest);
  embree.mask = 0xffffffff;
  return embree;
}

}  // namespace

struct RayCaster::Scene {
  using Vertex = std::array<float, 3>;
  using Face = std::array<std::uint32_t, 3>;

  explicit Scene(const Mesh& mesh) : device(rtcNewDevice(nullptr)), scene(rtcNewScene(device)) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::size_t num_vertices = mesh.vertices.size();
    const std::size_t num_faces = mesh.triangles.size();
    auto* vertices = new_buffer<Vertex>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, num_vertices);
    auto* faces = new_buffer<Face>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, num_faces);
    for (std::size_t i = 0; i < num_vertices; ++i) {
      vertices[i] = {mesh.vertices[i].x(), mesh.vertices[i].y(), mesh.vertices[i].z()};
    }
    for (std::size_t i = 0; i < num_faces; ++i) {
      faces[i] = {mesh.triangles[i].a, mesh.triangles[i].b, mesh.triangles[i].c};
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    commit();
  }

  // Where two surfaces coincide, the tree decides which one is hit: it is built by one thread, always the same.
  void commit() {
    const ThreadLimit one_thread(1);
    rtcCommitScene(scene);
  }

  ~Scene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  RTCDevice device;
  RTCScene scene;
};

RayCaster::RayCaster(const Mesh& mesh) : scene_(std::make_unique<Scene>(mesh)) {}
RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

std::optional<Hit> RayCaster::first_hit(const Ray& ray) const {
  RTCRayHit found{};
  found.ray = embree_ray(ray);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_->scene, &context, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  Eigen::Vector3d normal = Eigen::Vector3f(found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z).cast<double>().normalized();
  if (normal.dot(ray.direction) > 0) normal = -normal;
  return Hit{found.ray.tfar, found.hit.primID, normal};
}

bool RayCaster::is_blocked(const Ray& ray) const {
  RTCRay embree = embree_ray(ray);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene_->scene, &context, &embree);
  return embree.tfar < 0;  // Embree says so with minus infinity
}

}  // namespace vdbmap::simulator
