#include "sim/renderer.h"

#include <cmath>
#include <limits>
#include <thread>

#include "sim/pixel_rays.h"
#include "sim/ray_scene.h"
#include "sim/shading.h"
#include "sim/surfaces.h"

namespace rovigo::sim {
namespace {

static_assert(Texture::kSide == 512 && Texture::kLevels == 10, "shading.cpp knows these two");

constexpr float kFarM = 60.0F;

void linear_form(const Eigen::Vector3d& axis, const PixelRays& rays, float out[3]) {
  out[0] = static_cast<float>(axis.dot(rays.d0));
  out[1] = static_cast<float>(axis.dot(rays.dx));
  out[2] = static_cast<float>(axis.dot(rays.dy));
}

}  // namespace

struct Renderer::Impl {
  TextureLibrary library;
  Surfaces surfaces;
  std::vector<std::uint32_t> face_of_quad;
  std::vector<std::vector<const std::uint8_t*>> levels_of_face;
  std::unique_ptr<RayScene> scene;

  explicit Impl(const WorldModel& world) : surfaces(make_surfaces(world.solids, &library)) {
    for (const auto& quad : surfaces.quads) {
      face_of_quad.push_back(static_cast<std::uint32_t>(quad.face));
    }
    for (const auto& face : surfaces.faces) {
      auto& levels = levels_of_face.emplace_back();
      if (!face.texture) continue;
      for (const auto& texels : face.texture->texels) levels.push_back(texels.data());
    }
    scene = std::make_unique<RayScene>(surfaces.quads);
  }

  std::vector<FaceView> face_views(const PixelRays& rays) const {
    std::vector<FaceView> views(surfaces.faces.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
      const Face& face = surfaces.faces[i];
      FaceView& view = views[i];
      linear_form(face.normal, rays, view.n);
      linear_form(face.u_axis, rays, view.u);
      linear_form(face.v_axis, rays, view.v);
      const Eigen::Vector3d to_camera = rays.origin - face.origin;
      view.plane = static_cast<float>(-face.normal.dot(to_camera));
      view.u_start = static_cast<float>(face.u_offset + face.u_axis.dot(to_camera));
      view.v_start = static_cast<float>(face.v_offset + face.v_axis.dot(to_camera));
      for (int c = 0; c < 3; ++c) view.bgr[c] = face.color[2 - c];
      view.levels = face.texture ? levels_of_face[i].data() : nullptr;
    }
    return views;
  }
};

Renderer::Renderer(const WorldModel& world) : impl_(std::make_unique<Impl>(world)) {}
Renderer::~Renderer() = default;

void Renderer::render(const mrpt::poses::CPose3D& world_from_camera,
                      const mrpt::img::TCamera& camera, int threads, View& view) const {
  view.width = static_cast<int>(camera.ncols);
  view.height = static_cast<int>(camera.nrows);
  const auto pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
  view.depth_m.resize(pixels);
  view.cos_incidence.resize(pixels);
  view.bgr.resize(pixels * 3);
  const PixelRays rays = pixel_rays(world_from_camera, camera);
  const std::vector<FaceView> faces = impl_->face_views(rays);

  std::vector<float> column_slope;
  for (int x = 0; x < view.width; ++x) {
    column_slope.push_back(static_cast<float>((x - camera.cx()) / camera.fx()));
  }

  const auto render_rows = [&](int first_row, int row_step) {
    const auto width = static_cast<std::size_t>(view.width);
    std::vector<std::uint32_t> face(width);
    std::vector<float> t(width);
    std::vector<float> inverse_length(width);
    for (int y = first_row; y < view.height; y += row_step) {
      const Eigen::Vector3d first = rays.d0 + y * rays.dy;
      impl_->scene->cast_row(rays.origin.cast<float>(), first.cast<float>(), rays.dx.cast<float>(),
                             view.width, kFarM, face.data(), t.data());
      const auto ry = static_cast<float>((y - camera.cy()) / camera.fy());
      for (std::size_t x = 0; x < width; ++x) {
        if (face[x] != RayScene::kMiss) face[x] = impl_->face_of_quad[face[x]];
        const auto rx = column_slope[x];
        inverse_length[x] = 1.0F / std::sqrt(1.0F + rx * rx + ry * ry);
      }
      const std::size_t start = static_cast<std::size_t>(y) * width;
      shade_row(
          {faces.data(), face.data(), view.width, static_cast<float>(y), inverse_length.data()},
          &view.depth_m[start], &view.cos_incidence[start], &view.bgr[start * 3]);
    }
  };
  std::vector<std::thread> helpers;
  for (int i = 1; i < threads; ++i) helpers.emplace_back(render_rows, i, threads);
  render_rows(0, std::max(1, threads));
  for (auto& helper : helpers) helper.join();
}

}  // namespace rovigo::sim
