#pragma once
// A first-order model with dead time from a log of set-points and responses (mission F9).

#include <limits>
#include <vector>

namespace rovigo::control {

/// One row of a log. The set-point holds until the next row's. Units are the caller's.
struct IdentificationSample {
  double time_s = 0.0;  ///< increasing; the steps may be uneven
  double setpoint = 0.0;
  double response = 0.0;  ///< not finite: not measured in this row
};

/// time_constant_s * dy/dt + y = gain * u(t - dead_time_s)
struct FirstOrderModel {
  double gain = 1.0;  ///< response per set-point, at rest
  double time_constant_s = 0.0;
  double dead_time_s = 0.0;
};

enum class IdentificationStatus {
  kOk,
  kTooFewSamples,
  kNoExcitation,   ///< the set-point never changes
  kNoResponse,     ///< whatever the response does, it does not follow the set-point
  kVague,          ///< it follows, but the log does not tell how
  kNotFirstOrder,  ///< it follows in a way that no such model describes
};
const char* to_string(IdentificationStatus status);

/// 95 % confidence, from the residuals' size and correlation.
struct ConfidenceInterval {
  double low = 0.0;
  double high = 0.0;
};

struct IdentificationResult {
  IdentificationStatus status = IdentificationStatus::kTooFewSamples;
  FirstOrderModel model;  ///< best guess also where the status refuses it; else the default
  ConfidenceInterval gain_95;
  ConfidenceInterval time_constant_95_s;
  ConfidenceInterval dead_time_95_s;
  double initial_response = 0.0;  ///< of the model, at the first row
  /// 1 - |residual| / |response - its mean|: 1 is perfect, 0 no better than a constant.
  double fit_share = 0.0;
  double residual_rms = 0.0;
  /// fit_share on the second half of the log of a model made from the first half alone; not a
  /// number where a half says too little.
  double validation_fit_share = std::numeric_limits<double>::quiet_NaN();
  std::size_t samples = 0;  ///< measured responses used
};

struct IdentificationConfig {
  double max_dead_time_s = 1.0;
};

/// Output-error estimate: the model is simulated over the whole log, exactly for set-points that
/// hold between rows, and its four unknowns (gain, time constant, dead time, first response)
/// minimise the residuals: a grid over time constant and dead time, then Levenberg-Marquardt with
/// Huber's weights, so that outliers do not pull. After Ljung, System Identification, ch. 7 and 15.
/// Rows whose time is not later than the row before, or not finite, are left out.
IdentificationResult identify_first_order(const std::vector<IdentificationSample>& log,
                                          const IdentificationConfig& config = {});

/// The model's response at each row of the log.
std::vector<double> simulate(const FirstOrderModel& model,
                             const std::vector<IdentificationSample>& log, double initial_response);

}  // namespace rovigo::control
