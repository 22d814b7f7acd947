#include "slam/bundle_adjustment.h"

#include <ceres/ceres.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "slam/ceres_pose.h"
#include "slam/link_error.h"

namespace rovigo::slam {

namespace {

constexpr double kKernel = 2.5;       // sigmas
constexpr double kRejectChi2 = 16.0;  // of three degrees of freedom: 0.1% of honest sightings
constexpr double kPointFloorM = 0.002;

using Step = std::array<double, 6>;

/// One sighting: pixel and depth error of a landmark in a keyframe, with exact derivatives.
class SightingError final : public ceres::SizedCostFunction<3, 6, 3> {
 public:
  /// `origin`, `camera` and `camera_from_base` must outlive this.
  SightingError(const Se3& origin, const Feature& feature, const MeasurementNoise& noise,
                const CameraModel& camera, const Se3& camera_from_base)
      : origin_(origin),
        pixel_(feature.pixel.cast<double>()),
        depth_m_(feature.depth_m),
        noise_(noise),
        camera_(camera),
        camera_from_base_(camera_from_base) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Vector6d> step(parameters[0]);
    const Eigen::Map<const Eigen::Vector3d> point(parameters[1]);
    const Se3 pose = retract(origin_, step);
    const Eigen::Vector3d in_base = pose.rotation.transpose() * (point - pose.translation);
    const Eigen::Vector3d p = camera_from_base_ * in_base;
    const double z = std::max(0.05, p.z());  // behind the camera: a large but finite error
    const double iz = 1.0 / z;
    const Eigen::Vector2d pixel = camera_.project({p.x(), p.y(), z});
    const bool has_depth = depth_m_ > 0;
    residuals[0] = (pixel.x() - pixel_.x()) / noise_.pixel_sigma;
    residuals[1] = (pixel.y() - pixel_.y()) / noise_.pixel_sigma;
    residuals[2] = has_depth ? (p.z() - depth_m_) / noise_.depth_sigma_m : 0.0;
    if (jacobians == nullptr) return true;

    Eigen::Matrix3d by_point = Eigen::Matrix3d::Zero();
    by_point(0, 0) = camera_.fx() * iz / noise_.pixel_sigma;
    by_point(0, 2) = -camera_.fx() * p.x() * iz * iz / noise_.pixel_sigma;
    by_point(1, 1) = camera_.fy() * iz / noise_.pixel_sigma;
    by_point(1, 2) = -camera_.fy() * p.y() * iz * iz / noise_.pixel_sigma;
    if (has_depth) by_point(2, 2) = 1.0 / noise_.depth_sigma_m;
    const Eigen::Matrix3d by_base = by_point * camera_from_base_.rotation;
    if (jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 6, Eigen::RowMajor>> j(jacobians[0]);
      const Eigen::Matrix3d k = skew(step.tail<3>());
      const Eigen::Matrix3d right = Eigen::Matrix3d::Identity() - 0.5 * k + k * k / 6.0;
      j.leftCols<3>() = -by_base * pose.rotation.transpose() * origin_.rotation;
      j.rightCols<3>() = by_base * skew(in_base) * right;
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> j(jacobians[1]);
      j = by_base * pose.rotation.transpose();
    }
    return true;
  }

 private:
  const Se3& origin_;
  Eigen::Vector2d pixel_;
  double depth_m_;
  MeasurementNoise noise_;
  const CameraModel& camera_;
  const Se3& camera_from_base_;
};

/// A rover's height, roll and pitch are near zero.
struct FloorError {
  template <class T>
  bool operator()(const T* step, T* residual) const {
    const PoseOf<T> pose(origin, step);
    residual[0] = pose.translation(2) / T(height_sigma);
    residual[1] = pose.rotation(2, 1) / T(tilt_sigma);
    residual[2] = pose.rotation(2, 0) / T(tilt_sigma);
    return true;
  }
  Se3 origin;
  double height_sigma, tilt_sigma;
};

class Bundle {
 public:
  Bundle(LandmarkMap& map, const std::vector<int>& keyframes, const BundleConfig& config)
      : map_(map),
        config_(config),
        camera_from_base_(map.base_from_camera().inverse()),
        steps_(map.keyframes().size(), Step{}),
        is_free_(map.keyframes().size(), keyframes.empty() ? 1 : 0) {
    for (const int k : keyframes) is_free_[static_cast<std::size_t>(k)] = 1;
    if (!is_free_.empty()) is_free_[0] = 0;  // the map's frame hangs on it
    for (const Keyframe& k : map.keyframes()) origins_.push_back(k.map_from_base);
  }

  int add_sightings() {
    int count = 0;
    for (const int id : chosen_landmarks()) {
      Landmark& l = map_.landmark(id);
      for (const Sighting& s : l.sightings) {
        const Keyframe& k = map_.keyframe(s.keyframe);
        const Feature& f = k.features[static_cast<std::size_t>(s.feature)];
        problem_.AddResidualBlock(
            new SightingError(origin(s.keyframe), f, noise_of(f, map_.config()), map_.camera(),
                              camera_from_base_),
            &kernel_, step(s.keyframe), l.position_map.data());
        ++count;
      }
      ordering_->AddElementToGroup(l.position_map.data(), 0);
      used_.push_back(id);
    }
    return count;
  }

  void add_floor() {
    const TrackingConfig& t = map_.config().tracking;
    for (const Keyframe& k : map_.keyframes()) {
      if (!problem_.HasParameterBlock(step(k.id))) continue;
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<FloorError, 3, 6>(new FloorError{
                                    origin(k.id), t.plane_height_sigma_m, t.plane_tilt_sigma_rad}),
                                nullptr, step(k.id));
    }
  }

  void add_links(const std::vector<MotionLink>& links) {
    for (const MotionLink& l : links) {
      const bool concerned = is_free_[static_cast<std::size_t>(l.from)] != 0 ||
                             is_free_[static_cast<std::size_t>(l.to)] != 0;
      if (concerned) links_.push_back(l);
    }
    link_errors_.emplace(links_, map_.config().dead_reckoning);
    link_errors_->add_to(problem_, origins_, [this](int keyframe) { return step(keyframe); });
    // A group orders its members by address: each holds one array, so that the order never varies.
    for (auto& c : link_errors_->calibrations()) ordering_->AddElementToGroup(c.data(), 2);
  }

  ceres::Solver::Summary solve() {
    for (const Keyframe& k : map_.keyframes()) {
      if (!problem_.HasParameterBlock(step(k.id))) continue;
      ordering_->AddElementToGroup(step(k.id), 1);
      if (!is_free_[static_cast<std::size_t>(k.id)]) {
        problem_.SetParameterBlockConstant(step(k.id));
      }
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_SCHUR;
    options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    options.linear_solver_ordering = ordering_;
    options.num_threads = 1;
    options.max_num_iterations = config_.iterations;
    options.function_tolerance = 1e-4;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    return summary;
  }

  void apply() {
    std::vector<Se3> moved = origins_;
    for (std::size_t k = 0; k < moved.size(); ++k) {
      const Eigen::Map<const Vector6d> by(steps_[k].data());
      if (!by.isZero(0.0)) moved[k] = normalized(retract(moved[k], by));
    }
    std::vector<Eigen::Vector3d> solved;
    for (const int id : used_) solved.push_back(map_.landmark(id).position_map);
    map_.move_keyframes(moved);  // landmarks that were not asked follow the view that made them
    for (std::size_t i = 0; i < used_.size(); ++i) {
      map_.landmark(used_[i]).position_map = solved[i];
    }
  }

  /// Landmarks keep only sightings that fit, and learn how well they are known.
  int settle_landmarks() {
    int rejected = 0;
    for (std::size_t k = 0; k < origins_.size(); ++k) {
      origins_[k] = map_.keyframe(static_cast<int>(k)).map_from_base;
    }
    for (const int id : used_) {
      Landmark& l = map_.landmark(id);
      Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
      for (std::size_t i = l.sightings.size(); i-- > 0;) {
        const Sighting s = l.sightings[i];
        const Keyframe& k = map_.keyframe(s.keyframe);
        const Feature& f = k.features[static_cast<std::size_t>(s.feature)];
        const SightingError error(origin(s.keyframe), f, noise_of(f, map_.config()), map_.camera(),
                                  camera_from_base_);
        const Step zero{};
        const double* parameters[] = {zero.data(), l.position_map.data()};
        Eigen::Vector3d residual;
        Eigen::Matrix<double, 3, 3, Eigen::RowMajor> by_point;
        double* jacobians[] = {nullptr, by_point.data()};
        error.Evaluate(parameters, residual.data(), jacobians);
        if (residual.squaredNorm() > kRejectChi2) {
          map_.remove_sighting(id, static_cast<int>(i));
          ++rejected;
        } else {
          information += by_point.transpose() * by_point;
        }
      }
      if (!l.alive) continue;
      information.diagonal().array() += 1.0;  // invertible, whatever was seen
      Eigen::Matrix3d covariance = information.inverse();
      covariance.diagonal().array() += kPointFloorM * kPointFloorM;
      l.covariance = covariance.cast<float>();
    }
    return rejected;
  }

 private:
  /// Living landmarks that a free keyframe sees; the best seen ones first, until every view has
  /// enough. What the rest would add is not worth its time and memory.
  std::vector<int> chosen_landmarks() const {
    std::vector<int> candidates;
    for (std::size_t id = 0; id < map_.landmarks().size(); ++id) {
      const Landmark& l = map_.landmarks()[id];
      const bool concerned = std::any_of(l.sightings.begin(), l.sightings.end(), [&](auto& s) {
        return is_free_[static_cast<std::size_t>(s.keyframe)] != 0;
      });
      if (l.alive && concerned && l.sightings.size() >= config_.min_sightings) {
        candidates.push_back(static_cast<int>(id));
      }
    }
    std::stable_sort(candidates.begin(), candidates.end(), [&](int a, int b) {
      return map_.landmark(a).sightings.size() > map_.landmark(b).sightings.size();
    });
    const int enough = std::min(
        config_.landmarks_per_view,
        std::max(config_.fewest_per_view, config_.landmarks_in_views / map_.living_keyframes()));
    std::vector<int> in_view(map_.keyframes().size(), 0), chosen;
    for (const int id : candidates) {
      const auto& sightings = map_.landmark(id).sightings;
      const bool wanted = std::any_of(sightings.begin(), sightings.end(), [&](auto& s) {
        return in_view[static_cast<std::size_t>(s.keyframe)] < enough;
      });
      if (!wanted) continue;
      chosen.push_back(id);
      for (const Sighting& s : sightings) ++in_view[static_cast<std::size_t>(s.keyframe)];
    }
    return chosen;
  }

  const Se3& origin(int keyframe) const { return origins_[static_cast<std::size_t>(keyframe)]; }
  double* step(int keyframe) { return steps_[static_cast<std::size_t>(keyframe)].data(); }

  LandmarkMap& map_;
  BundleConfig config_;
  Se3 camera_from_base_;
  std::vector<Step> steps_;
  std::vector<Se3> origins_;  ///< the poses that the steps step away from
  std::vector<std::uint8_t> is_free_;
  std::vector<int> used_;
  std::vector<MotionLink> links_;
  std::optional<LinkErrors> link_errors_;
  ceres::HuberLoss kernel_{kKernel};
  ceres::Problem problem_{[] {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }()};
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_ =
      std::make_shared<ceres::ParameterBlockOrdering>();
};

}  // namespace

BundleResult adjust_bundle(LandmarkMap& map, const std::vector<int>& keyframes,
                           const std::vector<MotionLink>& links, const BundleConfig& config) {
  BundleResult result;
  if (map.keyframes().size() < 2) return result;
  Bundle bundle(map, keyframes, config);
  result.sightings = bundle.add_sightings();
  if (result.sightings == 0) return result;
  bundle.add_links(links);
  if (config.on_floor) bundle.add_floor();
  const ceres::Solver::Summary summary = bundle.solve();
  result.initial_cost = summary.initial_cost;
  result.final_cost = summary.final_cost;
  result.converged = summary.IsSolutionUsable();
  if (!result.converged) return result;
  bundle.apply();
  result.rejected = bundle.settle_landmarks();
  return result;
}

}  // namespace rovigo::slam
