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
  rtcSetSceneBuildQuality(impl_->scene, RTC_BUILD_QUALITY_HIGH);
  rtcCommitScene(impl_->scene);
}

RayScene::~RayScene() = default;

void RayScene::cast_row(const Eigen::Vector3f& origin, const Eigen::Vector3f& first,
                        const Eigen::Vector3f& step, int count, float max_t, std::uint32_t* quad,
                        float* t) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(32) int valid[8];
  RTCRayHit8 packet;
  for (int start = 0; start < count; start += 8) {
    const int used = std::min(8, count - start);
    for (int i = 0; i < 8; ++i) {
      const auto x = static_cast<float>(start + i);
      valid[i] = i < used ? -1 : 0;
      packet.ray.org_x[i] = origin.x();
      packet.ray.org_y[i] = origin.y();
      packet.ray.org_z[i] = origin.z();
      packet.ray.dir_x[i] = first.x() + x * step.x();
      packet.ray.dir_y[i] = first.y() + x * step.y();
      packet.ray.dir_z[i] = first.z() + x * step.z();
      packet.ray.tnear[i] = 1e-3F;
      packet.ray.tfar[i] = max_t;
      packet.ray.time[i] = 0.0F;
      packet.ray.mask[i] = 0xFFFFFFFFU;
      packet.ray.flags[i] = 0;
      packet.hit.primID[i] = kMiss;
      packet.hit.geomID[i] = kMiss;
      packet.hit.instID[0][i] = kMiss;
    }
    rtcIntersect8(valid, impl_->scene, &context, &packet);
    for (int i = 0; i < used; ++i) {
      quad[start + i] = packet.hit.geomID[i] == kMiss ? kMiss : packet.hit.primID[i];
      t[start + i] = packet.ray.tfar[i];
    }
  }
}

}  // namespace rovigo::sim
