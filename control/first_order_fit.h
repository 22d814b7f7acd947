#pragma once
// The least-squares fit behind identification.h: simulate, compare, correct.

#include <Eigen/Core>

#include "control/identification.h"

namespace rovigo::control {

/// Gain, log of the time constant, dead time, first response.
using FitParameters = Eigen::Vector4d;

/// Where the answer may lie.
struct FitRange {
  double least_time_constant_s = 0.0;
  double most_time_constant_s = 0.0;
  double most_dead_time_s = 0.0;
  double sample_step_s = 0.0;  ///< median
};

/// Response to the set-points with gain 1 from zero, and to nothing from 1: what gain and first
/// response multiply.
struct ResponseBases {
  Eigen::VectorXd forced;
  Eigen::VectorXd free;
};
/// Exact for set-points that hold between rows. Precondition: times increase.
ResponseBases simulate_bases(const std::vector<IdentificationSample>& rows, double time_constant_s,
                             double dead_time_s);

/// One fit. Residuals are zero where nothing was measured.
class FirstOrderFit {
 public:
  /// `rows` must outlive this; their times increase.
  FirstOrderFit(const std::vector<IdentificationSample>& rows, const FitRange& range);

  /// The best of a coarse grid; gain and first response follow by linear least squares.
  void search_grid();
  /// Levenberg-Marquardt; the weights follow the residuals' median size.
  void refine();

  const FitParameters& parameters() const { return parameters_; }
  Eigen::VectorXd residuals(const FitParameters& p) const;
  /// Of the parameters, given the residuals' size and how long they keep their sign.
  Eigen::Matrix4d covariance() const;
  /// Correlation of each residual with the one before.
  double correlation(const Eigen::VectorXd& residuals) const;

 private:
  double cost_of(const Eigen::VectorXd& r) const { return r.cwiseAbs2().dot(weights_); }
  FitParameters with_linear_part(double log_time_constant, double dead_time_s) const;
  /// Of the simulated response by the parameters.
  Eigen::MatrixXd jacobian() const;
  Eigen::VectorXd simulated(const FitParameters& p, double log_step, double dead_time_step) const;
  FitParameters bounded(FitParameters p) const;
  bool improve(double& damping);
  void update_weights(const Eigen::VectorXd& r);

  const std::vector<IdentificationSample>& rows_;
  FitRange range_;
  Eigen::VectorXd response_, measured_, weights_;
  FitParameters parameters_ = FitParameters::Zero();
};

}  // namespace rovigo::control
