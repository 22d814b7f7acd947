#include "slam/trajectory_evaluation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "maps/error.h"

namespace rovigo::slam {
namespace {

constexpr double kAssociation_s = 0.01;
constexpr double kCoverage_s = 0.02;
constexpr double kRpeStep_s = 1.0;
constexpr double kRpeTolerance_s = 0.02;  // how far from one second apart two poses may be

struct PosePair {
  double time_s = 0.0;
  Eigen::Isometry3d estimate;
  Eigen::Isometry3d truth;
};

Eigen::Isometry3d isometry_of(const mrpt::poses::CPose3D& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = pose.getRotationMatrix().asEigen();
  result.translation() = Eigen::Vector3d(pose.x(), pose.y(), pose.z());
  return result;
}

std::vector<StampedPose> in_time_order(std::vector<StampedPose> poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.time_s < b.time_s; });
  return poses;
}

/// First pose at `time_s` or later.
std::vector<StampedPose>::const_iterator at_or_after(const std::vector<StampedPose>& poses,
                                                     double time_s) {
  return std::lower_bound(poses.begin(), poses.end(), time_s,
                          [](const StampedPose& pose, double t) { return pose.time_s < t; });
}

/// Pairs within kAssociation_s, the closest first, each pose used once; in time order.
std::vector<PosePair> associate(const std::vector<StampedPose>& estimate,
                                const std::vector<StampedPose>& truth) {
  using Candidate = std::tuple<double, std::size_t, std::size_t>;  // difference, estimate, truth
  constexpr int kMostPerPose = 16;  // bounds the work when many poses share a time
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    auto near = at_or_after(truth, estimate[i].time_s - kAssociation_s);
    for (int n = 0; near != truth.end() && n < kMostPerPose; ++near, ++n) {
      const double difference = std::abs(near->time_s - estimate[i].time_s);
      if (difference > kAssociation_s) break;
      candidates.emplace_back(difference, i, static_cast<std::size_t>(near - truth.begin()));
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<bool> estimate_taken(estimate.size(), false);
  std::vector<bool> truth_taken(truth.size(), false);
  std::vector<PosePair> pairs;
  for (const auto& [difference, i, j] : candidates) {
    if (estimate_taken[i] || truth_taken[j]) continue;
    estimate_taken[i] = truth_taken[j] = true;
    pairs.push_back(
        {estimate[i].time_s, isometry_of(estimate[i].pose), isometry_of(truth[j].pose)});
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const PosePair& a, const PosePair& b) { return a.time_s < b.time_s; });
  return pairs;
}

struct Alignment {
  Eigen::Isometry3d truth_from_estimate = Eigen::Isometry3d::Identity();
  double similarity_scale = 1.0;
};

/// Umeyama 1991: the rotation (never a reflection) and translation of least squares, eq. 40-41;
/// the scale of eq. 42 is reported, not applied.
Alignment align(const std::vector<PosePair>& pairs) {
  const double n = static_cast<double>(pairs.size());
  Eigen::Vector3d mean_estimate = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_truth = Eigen::Vector3d::Zero();
  for (const PosePair& pair : pairs) {
    mean_estimate += pair.estimate.translation() / n;
    mean_truth += pair.truth.translation() / n;
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double variance_estimate = 0.0;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d e = pair.estimate.translation() - mean_estimate;
    covariance += (pair.truth.translation() - mean_truth) * e.transpose() / n;
    variance_estimate += e.squaredNorm() / n;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs.z() = -1.0;
  Alignment alignment;
  const Eigen::Matrix3d rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  alignment.truth_from_estimate.linear() = rotation;
  alignment.truth_from_estimate.translation() = mean_truth - rotation * mean_estimate;
  constexpr double kStill_m2 = 1e-12;
  if (variance_estimate > kStill_m2) {
    alignment.similarity_scale = svd.singularValues().dot(signs) / variance_estimate;
  }
  return alignment;
}

void measure_absolute_error(const std::vector<PosePair>& pairs, TrajectoryErrors& errors) {
  const Alignment alignment = align(pairs);
  double sum = 0.0;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d aligned = alignment.truth_from_estimate * pair.estimate.translation();
    const double error_m = (aligned - pair.truth.translation()).norm();
    sum += error_m * error_m;
    errors.ate_max_m = std::max(errors.ate_max_m, error_m);
  }
  errors.ate_rmse_m = std::sqrt(sum / static_cast<double>(pairs.size()));
  errors.similarity_scale = alignment.similarity_scale;
}

/// E_i = (Q_i^-1 Q_i+d)^-1 (P_i^-1 P_i+d), Sturm et al. 2012, eq. 2, with d = 1 s.
void measure_relative_error(const std::vector<PosePair>& pairs, TrajectoryErrors& errors) {
  double sum_translation = 0.0;
  double sum_rotation = 0.0;
  int count = 0;
  std::size_t j = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double wanted_s = pairs[i].time_s + kRpeStep_s;
    while (j + 1 < pairs.size() &&
           std::abs(pairs[j + 1].time_s - wanted_s) <= std::abs(pairs[j].time_s - wanted_s)) {
      ++j;
    }
    if (std::abs(pairs[j].time_s - wanted_s) > kRpeTolerance_s) continue;
    const Eigen::Isometry3d moved_truth = pairs[i].truth.inverse() * pairs[j].truth;
    const Eigen::Isometry3d moved_estimate = pairs[i].estimate.inverse() * pairs[j].estimate;
    const Eigen::Isometry3d error = moved_truth.inverse() * moved_estimate;
    const double angle_rad =
        Eigen::Quaterniond(error.linear()).angularDistance(Eigen::Quaterniond::Identity());
    sum_translation += error.translation().squaredNorm();
    sum_rotation += angle_rad * angle_rad;
    ++count;
  }
  if (count == 0) return;
  errors.rpe_translation_m = std::sqrt(sum_translation / count);
  errors.rpe_rotation_rad = std::sqrt(sum_rotation / count);
}

bool has_pose_near(const std::vector<StampedPose>& poses, double time_s) {
  const auto near = at_or_after(poses, time_s - kCoverage_s);
  return near != poses.end() && near->time_s <= time_s + kCoverage_s;
}

/// Every true pose stands for half the time to its neighbours, so that truth of uneven density
/// does not count twice.
double coverage_of(const std::vector<StampedPose>& estimate,
                   const std::vector<StampedPose>& truth) {
  double covered_s = 0.0;
  double whole_s = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double from_s = truth[i == 0 ? 0 : i - 1].time_s;
    const double to_s = truth[std::min(i + 1, truth.size() - 1)].time_s;
    const double share_s = 0.5 * (to_s - from_s);
    whole_s += share_s;
    if (has_pose_near(estimate, truth[i].time_s)) covered_s += share_s;
  }
  return whole_s > 0.0 ? covered_s / whole_s : 0.0;
}

}  // namespace

TrajectoryErrors evaluate_trajectory(const std::vector<StampedPose>& unsorted_estimate,
                                     const std::vector<StampedPose>& unsorted_truth) {
  const std::vector<StampedPose> estimate = in_time_order(unsorted_estimate);
  const std::vector<StampedPose> truth = in_time_order(unsorted_truth);
  const std::vector<PosePair> pairs = associate(estimate, truth);
  if (pairs.size() < 3) {
    throw maps::InputError("only " + std::to_string(pairs.size()) +
                           " poses of the estimate have a true pose within 0.01 s; at least 3 are "
                           "needed, so check that both files use the same clock");
  }
  TrajectoryErrors errors;
  errors.associated = static_cast<int>(pairs.size());
  measure_absolute_error(pairs, errors);
  measure_relative_error(pairs, errors);
  errors.coverage = coverage_of(estimate, truth);
  return errors;
}

}  // namespace rovigo::slam
