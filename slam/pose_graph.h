#pragma once
// Keyframe poses that agree best with all relative poses measured between them.

#include <vector>

#include "maps/map_file.h"
#include "slam/motion_link.h"
#include "slam/se3.h"

namespace rovigo::slam {

struct PoseGraphEdge {
  int from = 0;
  int to = 0;
  maps::StoredEdge::Kind kind = maps::StoredEdge::Kind::kOdometry;
  Se3 from_from_to;
  Matrix6d information = Matrix6d::Identity();  ///< in the chart of `retract`
};

struct PoseGraphResult {
  std::vector<Se3> poses;
  double initial_cost = 0.0;
  double final_cost = 0.0;
  /// Squared error of every edge after the optimisation, in sigmas; a loop that stays large is
  /// false.
  std::vector<double> edge_chi2;
  bool converged = false;
};

struct PoseGraph {
  std::vector<Se3> poses;
  std::vector<PoseGraphEdge> edges;
  std::vector<MotionLink> links;  ///< wheels and gyro; their calibration is solved for as well
};

/// Levenberg-Marquardt (Ceres) with Cauchy's kernel on loops, so that a false one is outvoted; the
/// first pose is held. One thread and Eigen's sparse solver: the same bytes on every machine.
PoseGraphResult optimize_pose_graph(const PoseGraph& graph, const DeadReckoningConfig& wheels,
                                    int iterations);

}  // namespace rovigo::slam
