// Random poses, random scenes, random outliers: the motion-only optimiser finds the pose back.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "slam/place_match.h"
#include "slam/pose_optimizer.h"

namespace rovigo::slam {
namespace {

mrpt::img::TCamera intrinsics() {
  mrpt::img::TCamera c;
  c.ncols = 640;
  c.nrows = 480;
  c.setIntrinsicParamsFromValues(500, 500, 320, 240);
  return c;
}

Se3 forward_camera() {
  Se3 s;
  s.rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  s.translation = {0.1, 0.0, 0.25};
  return s;
}

struct Scene {
  Se3 truth;
  std::vector<PointObservation> observations;
};

Scene random_scene(std::uint64_t seed, int points, double outlier_share) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::normal_distribution<double> noise;
  const CameraModel camera(intrinsics());
  Scene scene;
  Vector6d away;
  away << unit(random) * 5, unit(random) * 5, 0.1 * unit(random), 0.3 * unit(random),
      0.3 * unit(random), 3.0 * unit(random);
  scene.truth = retract(Se3{}, away);
  for (int i = 0; i < points; ++i) {
    const Eigen::Vector2d pixel(320 + 310 * unit(random), 240 + 230 * unit(random));
    const double z = 2.5 + 2.0 * unit(random);
    const Eigen::Vector3d in_camera = camera.unproject(pixel, z);
    PointObservation o;
    o.point_map = scene.truth * (forward_camera() * in_camera);
    o.pixel_sigma = 1.0;
    o.depth_sigma_m = 0.0022 * z * z;
    o.pixel = pixel + Eigen::Vector2d(noise(random), noise(random));
    o.depth_m = i % 4 == 0 ? 0.0 : z + o.depth_sigma_m * noise(random);
    if (unit(random) * 0.5 + 0.5 < outlier_share) {  // matched to the wrong corner
      o.pixel += Eigen::Vector2d(30 * unit(random), 30 * unit(random));
      o.depth_m *= 1.0 + 0.3 * unit(random);
    }
    scene.observations.push_back(o);
  }
  return scene;
}

TEST(PoseOptimizerProperty, RecoversRandomPosesInSpiteOfOutliers) {
  const CameraModel camera(intrinsics());
  for (const double share : {0.0, 0.2, 0.4}) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      const Scene scene = random_scene(seed, 200, share);
      Vector6d off;
      off << 0.03, -0.03, 0.01, 0.01, -0.01, 0.02;
      const PoseSolution s = optimize_pose(scene.observations, retract(scene.truth, off),
                                           std::nullopt, camera, forward_camera());
      const Vector6d error = local(scene.truth, s.map_from_base);
      EXPECT_LT(error.head<3>().norm(), 0.012) << "seed " << seed << ", outliers " << share;
      EXPECT_LT(error.tail<3>().norm(), 0.005) << "seed " << seed << ", outliers " << share;
      EXPECT_FALSE(s.degenerate);
      EXPECT_GT(s.inliers, 200 * (1 - share) * 0.8);
    }
  }
}

TEST(PoseOptimizerProperty, TheStatedInformationMatchesTheSpreadOfTheErrors) {
  // Mean squared error in sigmas over many scenes: 6 for an honest optimiser of 6 unknowns.
  const CameraModel camera(intrinsics());
  double sum = 0.0;
  constexpr int kScenes = 100;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
    const Scene scene = random_scene(1000 + seed, 150, 0.0);
    const PoseSolution s =
        optimize_pose(scene.observations, scene.truth, std::nullopt, camera, forward_camera());
    const Vector6d error = local(scene.truth, s.map_from_base);
    sum += error.dot(s.information * error);
  }
  EXPECT_GT(sum / kScenes, 4.0);
  EXPECT_LT(sum / kScenes, 9.0);
}

TEST(PoseOptimizerProperty, PointsInOneDirectionLeaveThePoseDegenerate) {
  Scene scene = random_scene(7, 40, 0.0);
  const PointObservation one = scene.observations.front();
  for (PointObservation& o : scene.observations) o = one;
  const PoseSolution s = optimize_pose(scene.observations, scene.truth, std::nullopt,
                                       CameraModel(intrinsics()), forward_camera());
  EXPECT_TRUE(s.degenerate);
}

TEST(PoseOptimizerProperty, WithoutObservationsThePriorRules) {
  PosePrior6 prior;
  prior.map_from_base = from_planar({1, 2, 0.5});
  prior.information.setIdentity();
  const PoseSolution s =
      optimize_pose({}, Se3{}, prior, CameraModel(intrinsics()), forward_camera());
  EXPECT_LT(local(prior.map_from_base, s.map_from_base).norm(), 1e-3);
  EXPECT_EQ(s.inliers, 0);
}

TEST(FitRigid, FindsRandomMotionsBack) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    Vector6d step;
    for (int k = 0; k < 6; ++k) step(k) = 2.0 * unit(random);
    const Se3 motion = retract(Se3{}, step);
    std::vector<Eigen::Vector3d> source, target;
    for (int k = 0; k < 5; ++k) {
      source.emplace_back(unit(random), unit(random), unit(random));
      target.push_back(motion * source.back());
    }
    const auto fit = fit_rigid(source, target);
    ASSERT_TRUE(fit.has_value());
    EXPECT_LT(local(motion, *fit).norm(), 1e-6);
  }
}

TEST(FitRigid, PointsInALineAreRefused) {
  const std::vector<Eigen::Vector3d> line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_FALSE(fit_rigid(line, line).has_value());
}

}  // namespace
}  // namespace rovigo::slam
