#include "sim/surfaces.h"

#include <array>
#include <cmath>

#include "sim/random.h"

namespace rovigo::sim {
namespace {

constexpr int kFrontSide = 3;  ///< a box's +x face, see add_box

/// Light from ceiling lamps everywhere: tops are brightest, undersides get what the floor returns,
/// and walls differ a little by heading so that corners show.
float light_on(const Eigen::Vector3d& normal) {
  const double upwards = normal.z() > 0.0 ? 0.22 * normal.z() : 0.30 * normal.z();
  const double sideways = 0.10 * normal.x() + 0.06 * normal.y();
  return static_cast<float>(0.78 + upwards + sideways);
}

class Builder {
 public:
  Builder(TextureLibrary* library, Surfaces& out) : library_(library), out_(out) {}

  void add(const Solid& solid) {
    corners_ = corners_of(solid);
    switch (solid.kind) {
      case Solid::Kind::kBox:
        return add_box(solid);
      case Solid::Kind::kCylinder:
        return add_cylinder(solid);
      case Solid::Kind::kPlane:
        return add_quad(solid, {0, 1, 2, 3}, 0, solid_axis(solid, 0), 0.0);
    }
  }

 private:
  static Eigen::Vector3d solid_axis(const Solid& solid, int i) {
    return solid.world_from_solid.linear().col(i);
  }

  void add_box(const Solid& solid) {
    const Eigen::Vector3d x = solid_axis(solid, 0);
    const Eigen::Vector3d y = solid_axis(solid, 1);
    add_quad(solid, {3, 2, 1, 0}, 0, x, 0.0);           // bottom
    add_quad(solid, {4, 5, 6, 7}, 1, x, 0.0);           // top
    add_quad(solid, {0, 1, 5, 4}, 2, x, 0.0);           // -y
    add_quad(solid, {1, 2, 6, 5}, kFrontSide, y, 0.0);  // +x
    add_quad(solid, {2, 3, 7, 6}, 4, -x, 0.0);          // +y
    add_quad(solid, {3, 0, 4, 7}, 5, -y, 0.0);          // -x
  }

  void add_cylinder(const Solid& solid) {
    constexpr int kN = kCylinderSides;
    const double chord = solid.size.x() * std::sin(maps::kPi / kN);
    for (int i = 0; i < kN; ++i) {
      const int j = (i + 1) % kN;
      const Eigen::Vector3d along = (corners_[j] - corners_[i]).normalized();
      add_quad(solid, {i, j, kN + j, kN + i}, 0, along, i * chord);
    }
    const Eigen::Vector3d x = solid_axis(solid, 0);
    for (int i = 1; i + 2 < kN; i += 2) {
      add_quad(solid, {0, i + 2, i + 1, i}, 1, x, 0.0);
      add_quad(solid, {kN, kN + i, kN + i + 1, kN + i + 2}, 2, x, 0.0);
    }
  }

  /// `side` tells the solid's faces apart, so that each shows another piece of the texture;
  /// `u_start_m` lets neighbouring strips of a cylinder continue each other.
  void add_quad(const Solid& solid, const std::array<int, 4>& index, int side,
                const Eigen::Vector3d& along, double u_start_m) {
    Quad quad;
    for (std::size_t i = 0; i < 4; ++i) {
      quad.corners[i] = corners_[static_cast<std::size_t>(index[i])];
    }
    Face face;
    face.normal =
        (quad.corners[1] - quad.corners[0]).cross(quad.corners[2] - quad.corners[0]).normalized();
    face.origin = quad.corners[0];
    face.texture = library_ ? library_->get(solid.material) : nullptr;
    const double scale = face.texture ? face.texture->texels_per_m : 1.0;
    face.u_axis = along * scale;
    face.v_axis = face.normal.cross(along) * scale;
    const std::uint64_t bits = derive_seed(solid.material.seed, static_cast<std::uint64_t>(side));
    face.u_offset = static_cast<double>(bits % Texture::kSide) + u_start_m * scale;
    face.v_offset = static_cast<double>((bits >> 32U) % Texture::kSide);
    if (solid.material.pattern == Pattern::kMarker) fit_marker(solid, quad, side, face);
    const auto& c = solid.material.color;
    face.color = Eigen::Vector3f(c[0], c[1], c[2]) * light_on(face.normal);
    quad.face = static_cast<int>(out_.faces.size());
    out_.faces.push_back(face);
    out_.quads.push_back(quad);
  }

  /// The print fills the +x face of a box once, from corner to corner.
  static void fit_marker(const Solid& solid, const Quad& quad, int side, Face& face) {
    if (solid.kind != Solid::Kind::kBox || side != kFrontSide) {
      face.texture = nullptr;
      return;
    }
    const Eigen::Vector3d u = quad.corners[1] - quad.corners[0];
    const Eigen::Vector3d v = quad.corners[3] - quad.corners[0];
    face.u_axis = u * (Texture::kSide / u.squaredNorm());
    face.v_axis = v * (Texture::kSide / v.squaredNorm());
    face.u_offset = face.v_offset = 0.0;
  }

  TextureLibrary* library_;
  Surfaces& out_;
  std::vector<Eigen::Vector3d> corners_;
};

}  // namespace

Surfaces make_surfaces(const std::vector<Solid>& solids, TextureLibrary* library) {
  Surfaces out;
  Builder builder(library, out);
  for (const auto& solid : solids) {
    if (solid.visible) builder.add(solid);
  }
  return out;
}

}  // namespace rovigo::sim
