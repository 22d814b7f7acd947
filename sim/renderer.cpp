#include "sim/renderer.h"

#include <Eigen/LU>
#include <algorithm>
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

using Levels = std::vector<std::vector<const std::uint8_t*>>;

Levels levels_of(const std::vector<Face>& faces) {
  Levels out;
  for (const auto& face : faces) {
    auto& levels = out.emplace_back();
    if (!face.texture) continue;
    for (const auto& texels : face.texture->texels) levels.push_back(texels.data());
  }
  return out;
}

void add_face_views(const std::vector<Face>& faces, const Levels& levels, const PixelRays& rays,
                    std::vector<FaceView>& views) {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Face& face = faces[i];
    FaceView& view = views.emplace_back();
    linear_form(face.normal, rays, view.n);
    linear_form(face.u_axis, rays, view.u);
    linear_form(face.v_axis, rays, view.v);
    const Eigen::Vector3d to_camera = rays.origin - face.origin;
    view.plane = static_cast<float>(-face.normal.dot(to_camera));
    view.u_start = static_cast<float>(face.u_offset + face.u_axis.dot(to_camera));
    view.v_start = static_cast<float>(face.v_offset + face.v_axis.dot(to_camera));
    for (int c = 0; c < 3; ++c) view.bgr[c] = face.color[2 - c];
    view.levels = face.texture ? levels[i].data() : nullptr;
  }
}

/// Pixels that a mover can cover.
struct Window {
  int left = 0;
  int right = 0;  ///< one past the last
  int top = 0;
  int bottom = 0;
};

Window window_of(const Mover& mover, const PixelRays& rays, int width, int height) {
  constexpr double kNearM = 0.05;
  Eigen::Matrix3d world_from_pixel;
  world_from_pixel << rays.dx, rays.dy, rays.d0;
  const Eigen::Matrix3d pixel_from_world = world_from_pixel.inverse();
  Eigen::Array2d low(width, height);
  Eigen::Array2d high(0.0, 0.0);
  for (const auto& solid : mover.solids) {
    for (const auto& corner : corners_of(solid)) {
      const Eigen::Vector3d p = pixel_from_world * (corner - rays.origin);
      if (p.z() < kNearM) return {0, width, 0, height};  // beside or around the camera
      const Eigen::Array2d at = p.head<2>().array() / p.z();
      low = low.min(at);
      high = high.max(at);
    }
  }
  const auto clip = [](double v, int most) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(most)));
  };
  return {clip(low.x() - 1.0, width), clip(high.x() + 2.0, width), clip(low.y() - 1.0, height),
          clip(high.y() + 2.0, height)};
}

/// Schlick's approximation of Fresnel's law, scaled.
inline float mirror_share(float mirror, float cosine) {
  constexpr float kHeadOn = 0.04F;
  const float q = 1.0F - cosine;
  return mirror * (kHeadOn + (1.0F - kHeadOn) * q * q * q * q * q);
}

}  // namespace

struct Renderer::Impl {
  TextureLibrary library;
  Surfaces surfaces;
  Levels levels;
  std::unique_ptr<RayScene> scene;
  std::vector<bool> is_floor;  ///< by face; all such faces lie at floor_z_m
  double floor_z_m = 0.0;

  explicit Impl(const WorldModel& world) : surfaces(make_surfaces(world.solids, &library)) {
    levels = levels_of(surfaces.faces);
    scene = std::make_unique<RayScene>(surfaces.quads);
    find_floor(world);
  }

  void find_floor(const WorldModel& world) {
    constexpr double kFlatM = 1e-3;
    double lowest = std::numeric_limits<double>::infinity();
    for (const auto& solid : world.solids) {
      if (solid.kind != Solid::Kind::kPlane || !solid.visible) continue;
      lowest = std::min(lowest, solid.world_from_solid.translation().z());
    }
    floor_z_m = lowest;
    for (const auto& face : surfaces.faces) {
      is_floor.push_back(face.normal.z() > 0.999 && std::abs(face.origin.z() - lowest) < kFlatM);
    }
  }
};

namespace {

/// What moves, as this frame's second scene. Faces and quads are numbered after the world's.
struct MovingScene {
  Surfaces surfaces;
  Levels levels;
  std::unique_ptr<RayScene> scene;

  MovingScene(const std::vector<Mover>& movers, TextureLibrary& library, const RayScene& device) {
    std::vector<Solid> solids;
    for (const auto& mover : movers) {
      solids.insert(solids.end(), mover.solids.begin(), mover.solids.end());
    }
    surfaces = make_surfaces(solids, &library);
    levels = levels_of(surfaces.faces);
    if (!surfaces.quads.empty()) scene = std::make_unique<RayScene>(surfaces.quads, device);
  }
};

/// One camera (or its mirror image) before both scenes: knows which face each ray of a row meets.
class Caster {
 public:
  Caster(const PixelRays& rays, const RayScene& world, const Surfaces& surfaces,
         const Levels& levels, const MovingScene& moving, const std::vector<Mover>& movers,
         int width, int height)
      : rays_(rays), world_(world), surfaces_(surfaces), moving_(moving), width_(width) {
    views_.reserve(surfaces.faces.size() + moving.surfaces.faces.size());
    add_face_views(surfaces.faces, levels, rays, views_);
    add_face_views(moving.surfaces.faces, moving.levels, rays, views_);
    for (const auto& mover : movers) windows_.push_back(window_of(mover, rays, width, height));
  }

  void cast(int y, const float* min_t, std::uint32_t* face, float* t) const {
    const Eigen::Vector3d first = rays_.d0 + y * rays_.dy;
    RayRow row;
    row.origin = rays_.origin.cast<float>();
    row.first = first.cast<float>();
    row.step = rays_.dx.cast<float>();
    row.count = width_;
    row.max_t = kFarM;
    row.min_t = min_t;
    world_.cast_row(row, face, t);
    const auto world_quads = static_cast<std::uint32_t>(surfaces_.quads.size());
    for (const auto& window : windows_) {
      if (y < window.top || y >= window.bottom || !moving_.scene) continue;
      moving_.scene->cast_nearer(row, window.left, window.right, world_quads, face, t);
    }
    const auto world_faces = static_cast<std::uint32_t>(surfaces_.faces.size());
    for (int x = 0; x < width_; ++x) {
      if (face[x] == RayScene::kMiss) continue;
      face[x] = face[x] < world_quads
                    ? static_cast<std::uint32_t>(surfaces_.quads[face[x]].face)
                    : world_faces + static_cast<std::uint32_t>(
                                        moving_.surfaces.quads[face[x] - world_quads].face);
    }
  }

  const FaceView* views() const { return views_.data(); }

 private:
  const PixelRays& rays_;
  const RayScene& world_;
  const Surfaces& surfaces_;
  const MovingScene& moving_;
  int width_;
  std::vector<FaceView> views_;
  std::vector<Window> windows_;
};

/// Buffers of one row, and of the row that the floor mirrors.
struct RowBuffers {
  explicit RowBuffers(std::size_t width)
      : face(width), t(width), inverse_length(width), depth(width), cosine(width), bgr(width * 3) {}
  std::vector<std::uint32_t> face;
  std::vector<float> t;
  std::vector<float> inverse_length;
  std::vector<float> depth;
  std::vector<float> cosine;
  std::vector<float> bgr;
};

}  // namespace

Renderer::Renderer(const WorldModel& world) : impl_(std::make_unique<Impl>(world)) {}
Renderer::~Renderer() = default;

void Renderer::render(const ViewRequest& request, View& view) const {
  const auto& camera = request.camera;
  view.width = static_cast<int>(camera.ncols);
  view.height = static_cast<int>(camera.nrows);
  const auto width = static_cast<std::size_t>(view.width);
  const auto pixels = width * static_cast<std::size_t>(view.height);
  const bool mirrors = request.mirror > 0.0 && std::isfinite(impl_->floor_z_m);
  view.depth_m.resize(pixels);
  view.cos_incidence.resize(pixels);
  view.bgr.resize(pixels * 3);
  view.mirror_depth_m.assign(mirrors ? pixels : 0, std::numeric_limits<float>::quiet_NaN());

  const MovingScene moving(request.movers, impl_->library, *impl_->scene);
  const PixelRays rays = pixel_rays(request.world_from_camera, camera);
  const PixelRays below = mirrored(rays, mirrors ? impl_->floor_z_m : 0.0);
  const Caster direct(rays, *impl_->scene, impl_->surfaces, impl_->levels, moving, request.movers,
                      view.width, view.height);
  std::unique_ptr<Caster> reflected;
  if (mirrors) {
    reflected = std::make_unique<Caster>(below, *impl_->scene, impl_->surfaces, impl_->levels,
                                         moving, request.movers, view.width, view.height);
  }

  std::vector<float> column_slope;
  for (int x = 0; x < view.width; ++x) {
    column_slope.push_back(static_cast<float>((x - camera.cx()) / camera.fx()));
  }

  /// Mixes into a shaded row what its floor mirrors.
  const auto mirror_row = [&](int y, const RowBuffers& row, RowBuffers& image,
                              std::vector<float>& min_t) {
    const std::size_t start = static_cast<std::size_t>(y) * width;
    bool any = false;
    for (std::size_t x = 0; x < width; ++x) {
      const bool floor = row.face[x] < impl_->is_floor.size() && impl_->is_floor[row.face[x]];
      min_t[x] = floor ? view.depth_m[start + x] * 1.001F + 1e-3F : -1.0F;
      any |= floor;
    }
    if (!any) return;
    reflected->cast(y, min_t.data(), image.face.data(), image.t.data());
    shade_row({reflected->views(), image.face.data(), view.width, static_cast<float>(y),
               row.inverse_length.data()},
              image.depth.data(), image.cosine.data(), image.bgr.data());
    for (std::size_t x = 0; x < width; ++x) {
      if (min_t[x] < 0.0F) continue;
      view.mirror_depth_m[start + x] = image.depth[x];
      const float w =
          mirror_share(static_cast<float>(request.mirror), view.cos_incidence[start + x]);
      for (std::size_t c = 0; c < 3; ++c) {
        float& color = view.bgr[(start + x) * 3 + c];
        color += w * (image.bgr[x * 3 + c] - color);
      }
    }
  };

  const auto render_rows = [&](int first_row, int row_step) {
    RowBuffers row(width);
    RowBuffers image(mirrors ? width : 0);
    std::vector<float> min_t(mirrors ? width : 0);
    for (int y = first_row; y < view.height; y += row_step) {
      direct.cast(y, nullptr, row.face.data(), row.t.data());
      const auto ry = static_cast<float>((y - camera.cy()) / camera.fy());
      for (std::size_t x = 0; x < width; ++x) {
        const auto rx = column_slope[x];
        row.inverse_length[x] = 1.0F / std::sqrt(1.0F + rx * rx + ry * ry);
      }
      const std::size_t start = static_cast<std::size_t>(y) * width;
      shade_row({direct.views(), row.face.data(), view.width, static_cast<float>(y),
                 row.inverse_length.data()},
                &view.depth_m[start], &view.cos_incidence[start], &view.bgr[start * 3]);
      if (mirrors) mirror_row(y, row, image, min_t);
    }
  };
  std::vector<std::thread> helpers;
  const int threads = std::max(1, request.threads);
  for (int i = 1; i < threads; ++i) helpers.emplace_back(render_rows, i, threads);
  render_rows(0, threads);
  for (auto& helper : helpers) helper.join();
}

}  // namespace rovigo::sim
