// A person's shape: boxes on a skeleton that walks.

#include <algorithm>
#include <cmath>

#include "sim/people.h"

namespace rovigo::sim {
namespace {

using Color = std::array<float, 3>;

struct Outfit {
  Color shirt;
  Pattern shirt_pattern;
  Color trousers;
  Pattern trousers_pattern;
  Color hair;
};

const Outfit& outfit(std::size_t number) {
  static const Outfit kOutfits[] = {
      {{0.75F, 0.25F, 0.22F},
       Pattern::kPoster,
       {0.25F, 0.32F, 0.50F},
       Pattern::kNoise,
       {0.15F, 0.10F, 0.08F}},
      {{0.30F, 0.55F, 0.35F},
       Pattern::kNoise,
       {0.40F, 0.36F, 0.30F},
       Pattern::kCarpet,
       {0.45F, 0.32F, 0.18F}},
      {{0.85F, 0.80F, 0.55F},
       Pattern::kBricks,
       {0.22F, 0.22F, 0.26F},
       Pattern::kNoise,
       {0.30F, 0.30F, 0.32F}},
  };
  return kOutfits[number % std::size(kOutfits)];
}

Eigen::Isometry3d at(double x, double y, double z) {
  Eigen::Isometry3d m = Eigen::Isometry3d::Identity();
  m.translation() << x, y, z;
  return m;
}

Eigen::Isometry3d swung(double forward_rad) {
  Eigen::Isometry3d m = Eigen::Isometry3d::Identity();
  m.linear() = Eigen::AngleAxisd(-forward_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return m;
}

class Body {
 public:
  Body(const People::Person& person, std::size_t number)
      : world_from_person_(at(person.at.x, person.at.y, 0.0) *
                           Eigen::AngleAxisd(person.heading_rad, Eigen::Vector3d::UnitZ())),
        name_("person_" + std::to_string(number + 1) + "::"),
        outfit_(outfit(number)),
        phase_(person.stride_rad),
        effort_(std::min(1.0, person.velocity.norm() / 0.9)) {}

  std::vector<Solid> build() {
    leg(0.10, phase_);
    leg(-0.10, phase_ + maps::kPi);
    box("hips", at(0, 0, 0.93), {0.22, 0.34, 0.18}, outfit_.trousers, outfit_.trousers_pattern);
    box("torso", at(0, 0, 1.22), {0.24, 0.42, 0.46}, outfit_.shirt, outfit_.shirt_pattern);
    arm(0.26, phase_ + maps::kPi);
    arm(-0.26, phase_);
    box("neck", at(0, 0, 1.48), {0.11, 0.11, 0.08}, kSkin, Pattern::kPlain);
    box("head", at(0.01, 0, 1.60), {0.19, 0.16, 0.20}, kSkin, Pattern::kPlaster);
    box("hair", at(-0.02, 0, 1.71), {0.20, 0.17, 0.09}, outfit_.hair, Pattern::kNoise);
    stand_on_floor();
    return std::move(solids_);
  }

 private:
  /// Legs that swing are shorter than straight ones: the hips sink until a foot is down.
  void stand_on_floor() {
    double low = 1e9;
    for (const auto& solid : solids_) {
      for (const auto& p : corners_of(solid)) low = std::min(low, p.z());
    }
    for (auto& solid : solids_) solid.world_from_solid.translation().z() -= low;
  }

  static constexpr Color kSkin{0.80F, 0.62F, 0.50F};
  static constexpr Color kShoe{0.12F, 0.11F, 0.11F};

  void box(const std::string& part, const Eigen::Isometry3d& person_from_box,
           const Eigen::Vector3d& size, const Color& color, Pattern pattern) {
    Solid solid;
    solid.size = size;
    solid.world_from_solid = world_from_person_ * person_from_box;
    solid.name = name_ + part;
    solid.material = {color, pattern, name_seed(solid.name)};
    solid.touchable = false;
    solids_.push_back(std::move(solid));
  }

  void leg(double y, double phase) {
    constexpr double kHipM = 0.90;
    constexpr double kThighM = 0.44;
    constexpr double kShinM = 0.40;
    const double swing = 0.40 * effort_ * std::sin(phase);
    const double bend = 0.6 * effort_ * std::max(0.0, std::cos(phase));  // while it comes forward
    const std::string side = y > 0 ? "left_" : "right_";
    const Eigen::Isometry3d hip = at(0, y, kHipM) * swung(swing);
    const Eigen::Isometry3d knee = hip * at(0, 0, -kThighM) * swung(-bend);
    box(side + "thigh", hip * at(0, 0, -kThighM / 2), {0.17, 0.16, kThighM + 0.04},
        outfit_.trousers, outfit_.trousers_pattern);
    box(side + "shin", knee * at(0, 0, -kShinM / 2), {0.13, 0.13, kShinM + 0.02}, outfit_.trousers,
        outfit_.trousers_pattern);
    const Eigen::Vector3d ankle = (knee * at(0, 0, -kShinM)).translation();
    box(side + "shoe", at(ankle.x() + 0.05, ankle.y(), ankle.z()), {0.28, 0.10, 0.09}, kShoe,
        Pattern::kPlain);
  }

  void arm(double y, double phase) {
    const double swing = 0.35 * effort_ * std::sin(phase);
    const std::string side = y > 0 ? "left_" : "right_";
    const Eigen::Isometry3d shoulder = at(0, y, 1.42) * swung(swing);
    const Eigen::Isometry3d elbow = shoulder * at(0, 0, -0.30) * swung(0.25 + 0.2 * effort_);
    box(side + "arm", shoulder * at(0, 0, -0.15), {0.11, 0.10, 0.32}, outfit_.shirt,
        outfit_.shirt_pattern);
    box(side + "forearm", elbow * at(0, 0, -0.13), {0.09, 0.08, 0.28}, kSkin, Pattern::kPlaster);
  }

  Eigen::Isometry3d world_from_person_;
  std::string name_;
  const Outfit& outfit_;
  double phase_;
  double effort_;
  std::vector<Solid> solids_;
};

}  // namespace

std::vector<Solid> person_body(const People::Person& person, std::size_t number) {
  return Body(person, number).build();
}

}  // namespace rovigo::sim
