#include "slam/pose_graph.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <array>
#include <memory>

#include "slam/ceres_pose.h"
#include "slam/link_error.h"

namespace rovigo::slam {

namespace {

constexpr double kLoopKernel = 2.0;  // sigmas at which a loop begins to lose its vote

struct EdgeError {
  EdgeError(const PoseGraphEdge& edge, const Se3& from_pose, const Se3& to_pose)
      : measured(edge.from_from_to), from_origin(from_pose), to_origin(to_pose) {
    const Eigen::LLT<Matrix6d> cholesky(edge.information);
    weight = cholesky.matrixU();
  }

  template <class T>
  bool operator()(const T* from_step, const T* to_step, T* residual) const {
    const PoseOf<T> from(from_origin, from_step), to(to_origin, to_step);
    const Eigen::Matrix<T, 3, 3> measured_rotation = measured.rotation.cast<T>();
    const Eigen::Matrix<T, 3, 1> between =
        from.rotation.transpose() * (to.translation - from.translation);
    const Eigen::Matrix<T, 3, 3> turn =
        measured_rotation.transpose() * from.rotation.transpose() * to.rotation;
    Eigen::Matrix<T, 6, 1> error;
    error.template head<3>() =
        measured_rotation.transpose() * (between - measured.translation.cast<T>());
    ceres::RotationMatrixToAngleAxis(turn.data(), error.data() + 3);
    Eigen::Map<Eigen::Matrix<T, 6, 1>> out(residual);
    out = weight.cast<T>() * error;
    return true;
  }

  Se3 measured, from_origin, to_origin;
  Matrix6d weight;
};

double chi2_of(const PoseGraphEdge& e, const std::vector<Se3>& poses) {
  const Se3 found =
      poses[static_cast<std::size_t>(e.from)].inverse() * poses[static_cast<std::size_t>(e.to)];
  const Vector6d error = local(e.from_from_to, found);
  return error.dot(e.information * error);
}

}  // namespace

PoseGraphResult optimize_pose_graph(const PoseGraph& graph, const DeadReckoningConfig& wheels,
                                    int iterations) {
  const std::vector<Se3>& poses = graph.poses;
  const std::vector<PoseGraphEdge>& edges = graph.edges;
  PoseGraphResult result;
  result.poses = poses;
  if (poses.empty() || edges.empty()) return result;
  std::vector<std::array<double, 6>> steps(poses.size(), std::array<double, 6>{});
  LinkErrors links(graph.links, wheels);
  ceres::CauchyLoss loop_kernel(kLoopKernel);
  ceres::Problem::Options shared_losses;
  shared_losses.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(shared_losses);
  for (const PoseGraphEdge& e : edges) {
    const auto from = static_cast<std::size_t>(e.from), to = static_cast<std::size_t>(e.to);
    auto* cost = new ceres::AutoDiffCostFunction<EdgeError, 6, 6, 6>(
        new EdgeError(e, poses[from], poses[to]));
    ceres::LossFunction* loss = e.kind == maps::StoredEdge::Kind::kLoop ? &loop_kernel : nullptr;
    problem.AddResidualBlock(cost, loss, steps[from].data(), steps[to].data());
  }
  links.add_to(problem, poses,
               [&](int keyframe) { return steps[static_cast<std::size_t>(keyframe)].data(); });
  if (problem.HasParameterBlock(steps[0].data())) {
    problem.SetParameterBlockConstant(steps[0].data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = iterations;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  result.initial_cost = summary.initial_cost;
  result.final_cost = summary.final_cost;
  result.converged = summary.IsSolutionUsable();
  if (!result.converged) return result;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    result.poses[i] = normalized(retract(poses[i], Eigen::Map<const Vector6d>(steps[i].data())));
  }
  for (const PoseGraphEdge& e : edges) result.edge_chi2.push_back(chi2_of(e, result.poses));
  return result;
}

}  // namespace rovigo::slam
