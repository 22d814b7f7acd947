// A square driven three times with drifting odometry and true loops; then false loops are planted.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "slam/pose_graph.h"

namespace rovigo::slam {
namespace {

constexpr int kPerLap = 40;
constexpr int kLaps = 3;

struct Graph {
  std::vector<Se3> truth;
  std::vector<Se3> drifted;
  std::vector<PoseGraphEdge> edges;
};

Matrix6d information(double sigma_m, double sigma_rad) {
  Vector6d sigma;
  sigma.head<3>().setConstant(sigma_m);
  sigma.tail<3>().setConstant(sigma_rad);
  return sigma.cwiseAbs2().cwiseInverse().asDiagonal();
}

Graph square(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise;
  Graph g;
  TPose2D at;
  for (int i = 0; i < kPerLap * kLaps; ++i) {
    g.truth.push_back(from_planar(at));
    at = maps::compose(at, {0.3, 0, i % 10 == 9 ? 1.5707963267948966 : 0.0});
  }
  g.drifted.push_back(g.truth.front());
  for (std::size_t i = 1; i < g.truth.size(); ++i) {
    PoseGraphEdge e;
    e.from = static_cast<int>(i) - 1;
    e.to = static_cast<int>(i);
    Vector6d error;
    error << 0.005 * noise(random), 0.005 * noise(random), 0, 0, 0, 0.005 * noise(random);
    e.from_from_to = retract(g.truth[i - 1].inverse() * g.truth[i], error);
    e.information = information(0.005, 0.005);
    g.drifted.push_back(g.drifted.back() * e.from_from_to);
    g.edges.push_back(e);
  }
  for (int lap = 1; lap < kLaps; ++lap) {
    for (int k = 0; k < kPerLap; k += 5) {
      PoseGraphEdge e;
      e.kind = maps::StoredEdge::Kind::kLoop;
      e.from = k;
      e.to = lap * kPerLap + k;
      e.from_from_to = g.truth[static_cast<std::size_t>(e.from)].inverse() *
                       g.truth[static_cast<std::size_t>(e.to)];
      e.information = information(0.01, 0.01);
      g.edges.push_back(e);
    }
  }
  return g;
}

double rmse(const std::vector<Se3>& poses, const std::vector<Se3>& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    sum += (poses[i].translation - truth[i].translation).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(poses.size()));
}

PoseGraphEdge false_loop(std::mt19937_64& random) {
  PoseGraphEdge e;
  e.kind = maps::StoredEdge::Kind::kLoop;
  e.from = static_cast<int>(random() % 20);
  e.to = 30 + static_cast<int>(random() % 80);
  e.information = information(0.01, 0.01);  // "these two are the same place": confident and wrong
  return e;
}

TEST(PoseGraphProperty, TrueLoopsTakeTheDriftOut) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Graph g = square(seed);
    const PoseGraphResult r = optimize_pose_graph({g.drifted, g.edges, {}}, {}, 30);
    ASSERT_TRUE(r.converged);
    EXPECT_LT(rmse(r.poses, g.truth), 0.05) << "seed " << seed;
    EXPECT_LT(rmse(r.poses, g.truth), 0.5 * rmse(g.drifted, g.truth)) << "seed " << seed;
  }
}

TEST(PoseGraphProperty, PlantedFalseLoopsDoNotBendTheMap) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Graph g = square(seed);
    const double without =
        rmse(optimize_pose_graph({g.drifted, g.edges, {}}, {}, 30).poses, g.truth);
    std::mt19937_64 random(seed);
    const std::size_t honest = g.edges.size();
    for (int i = 0; i < 4; ++i) {
      // Only loops that are far from true: from a corner of the square to the opposite side.
      PoseGraphEdge e = false_loop(random);
      const Se3 real = g.truth[static_cast<std::size_t>(e.from)].inverse() *
                       g.truth[static_cast<std::size_t>(e.to)];
      if (real.translation.norm() < 1.0) continue;
      g.edges.push_back(e);
    }
    ASSERT_GT(g.edges.size(), honest) << "seed " << seed;
    const PoseGraphResult r = optimize_pose_graph({g.drifted, g.edges, {}}, {}, 60);
    ASSERT_TRUE(r.converged);
    EXPECT_LT(rmse(r.poses, g.truth), without + 0.03) << "seed " << seed;
    for (std::size_t i = honest; i < g.edges.size(); ++i) {
      EXPECT_GT(r.edge_chi2[i], 1000.0) << "a false loop must stand out, seed " << seed;
    }
  }
}

TEST(PoseGraphProperty, TheSameGraphGivesTheSameBits) {
  const Graph g = square(3);
  const PoseGraphResult a = optimize_pose_graph({g.drifted, g.edges, {}}, {}, 20);
  const PoseGraphResult b = optimize_pose_graph({g.drifted, g.edges, {}}, {}, 20);
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    EXPECT_EQ(a.poses[i].translation, b.poses[i].translation);
    EXPECT_EQ(a.poses[i].rotation, b.poses[i].rotation);
  }
}

TEST(PoseGraphProperty, AnEmptyGraphChangesNothing) {
  EXPECT_TRUE(optimize_pose_graph({}, {}, 10).poses.empty());
  EXPECT_EQ(optimize_pose_graph({{Se3{}}, {}, {}}, {}, 10).poses.size(), 1u);
}

TEST(PoseGraph, OneLoopTeachesTheWheelsScale) {
  // 10 m out and 10 m back with wheels that read 3% too little; the end is known to be the start.
  constexpr double kScale = 0.03;
  PoseGraph graph;
  std::vector<Se3> truth;
  TPose2D believed, at;
  for (int i = 0; i <= 40; ++i) {
    truth.push_back(from_planar(at));
    graph.poses.push_back(from_planar(believed));
    const double turn = i == 20 ? maps::kPi : 0.0;
    MotionLink link;
    link.from = i;
    link.to = i + 1;
    link.begin_s = i;
    link.end_s = i + 1;
    link.from_from_to = {0.5 / (1.0 + kScale), 0, turn};
    link.by_calibration(0, 1) = link.from_from_to.x;
    link.covariance = Eigen::Vector3d(1e-6, 1e-6, 1e-8).asDiagonal();
    if (i < 40) graph.links.push_back(link);
    at = maps::compose(at, {0.5, 0, turn});
    believed = maps::compose(believed, link.from_from_to);
  }
  // A landmark seen from 5 m and from 7 m along the way fixes the scale.
  PoseGraphEdge seen;
  seen.from = 10;
  seen.to = 14;
  seen.from_from_to = truth[10].inverse() * truth[14];
  seen.information = information(0.002, 0.001);
  graph.edges.push_back(seen);
  const PoseGraphResult r = optimize_pose_graph(graph, DeadReckoningConfig{}, 30);
  ASSERT_TRUE(r.converged);
  EXPECT_GT(rmse(graph.poses, truth), 0.1);
  for (const Se3& pose : r.poses) EXPECT_NEAR(pose.translation.z(), 0.0, 0.01);
  EXPECT_LT(rmse(r.poses, truth), 0.03);
}

}  // namespace
}  // namespace rovigo::slam
