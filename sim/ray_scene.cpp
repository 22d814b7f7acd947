#include "sim/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <stdexcept>

namespace rovigo::sim {

struct RayScene::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

RayScene::RayScene(const std::vector<Quad>& quads) : impl_(std::make_unique<Impl>()) {
  // One instruction set everywhere: hits differ in the last bit between them.
  const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  impl_->device = rtcNewDevice(has_avx2 ? "threads=1,isa=avx2" : "threads=1,isa=sse4.2");
  if (!impl_->device) throw std::runtime_error("Embree does not start on this processor");
  build(quads, false);
}

RayScene::RayScene(const std::vector<Quad>& quads, const RayScene& device_of)
    : impl_(std::make_unique<Impl>()) {
  impl_->device = device_of.impl_->device;
  rtcRetainDevice(impl_->device);
  build(quads, true);
}

void RayScene::build(const std::vector<Quad>& quads, bool often) {
  impl_->scene = rtcNewScene(impl_->device);
  RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_QUAD);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), quads.size() * 4));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4,
                              4 * sizeof(std::uint32_t), quads.size()));
  for (std::size_t q = 0; q < quads.size(); ++q) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        vertices[(q * 4 + i) * 3 + static_cast<std::size_t>(axis)] =
            static_cast<float>(quads[q].corners[i][axis]);
      }
      indices[q * 4 + i] = static_cast<std::uint32_t>(q * 4 + i);
    }
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(impl_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcSetSceneBuildQuality(impl_->scene, often ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_HIGH);
  rtcCommitScene(impl_->scene);
}

RayScene::~RayScene() = default;

namespace {

/// Rays begin .. end - 1 in packets of eight. `far_t(x)` is where a ray ends; `on_hit(x, quad, t)`
/// is called for rays that met something, `on_miss(x)` for the others.
template <class FarT, class OnHit, class OnMiss>
void cast(RTCScene scene, const RayRow& row, int begin, int end, const FarT& far_t,
          const OnHit& on_hit, const OnMiss& on_miss) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(32) int valid[8];
  RTCRayHit8 packet;
  for (int start = begin; start < end; start += 8) {
    const int used = std::min(8, end - start);
    bool any = false;
    for (int i = 0; i < 8; ++i) {
      const int column = std::min(start + i, end - 1);
      const auto x = static_cast<float>(start + i);
      const float near_t = row.min_t ? row.min_t[column] : 1e-3F;
      valid[i] = i < used && near_t >= 0.0F ? -1 : 0;
      any |= valid[i] != 0;
      packet.ray.org_x[i] = row.origin.x();
      packet.ray.org_y[i] = row.origin.y();
      packet.ray.org_z[i] = row.origin.z();
      packet.ray.dir_x[i] = row.first.x() + x * row.step.x();
      packet.ray.dir_y[i] = row.first.y() + x * row.step.y();
      packet.ray.dir_z[i] = row.first.z() + x * row.step.z();
      packet.ray.tnear[i] = near_t;
      packet.ray.tfar[i] = far_t(column);
      packet.ray.time[i] = 0.0F;
      packet.ray.mask[i] = 0xFFFFFFFFU;
      packet.ray.flags[i] = 0;
      packet.hit.primID[i] = RayScene::kMiss;
      packet.hit.geomID[i] = RayScene::kMiss;
      packet.hit.instID[0][i] = RayScene::kMiss;
    }
    if (any) rtcIntersect8(valid, scene, &context, &packet);
    for (int i = 0; i < used; ++i) {
      if (packet.hit.geomID[i] == RayScene::kMiss) {
        on_miss(start + i);
      } else {
        on_hit(start + i, packet.hit.primID[i], packet.ray.tfar[i]);
      }
    }
  }
}

}  // namespace

void RayScene::cast_row(const RayRow& row, std::uint32_t* quad, float* t) const {
  cast(
      impl_->scene, row, 0, row.count, [&](int) { return row.max_t; },
      [&](int x, std::uint32_t id, float at) {
        quad[x] = id;
        t[x] = at;
      },
      [&](int x) {
        quad[x] = kMiss;
        t[x] = row.max_t;
      });
}

void RayScene::cast_nearer(const RayRow& row, int begin, int end, std::uint32_t first_quad,
                           std::uint32_t* quad, float* t) const {
  cast(
      impl_->scene, row, begin, end, [&](int x) { return t[x]; },
      [&](int x, std::uint32_t id, float at) {
        quad[x] = first_quad + id;
        t[x] = at;
      },
      [](int) {});
}

}  // namespace rovigo::sim
