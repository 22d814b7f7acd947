#include "app/report/drive_tables.h"

#include <cmath>

#include "app/report/drive_report.h"
#include "app/report/number_text.h"
#include "maps/atomic_file.h"

namespace rovigo::app {
namespace {

constexpr int kDecimals = 6;

void append_row(std::string& out, std::initializer_list<double> values) {
  for (const double v : values) {
    if (!out.empty() && out.back() != '\n') out += ',';
    out += fixed(v, kDecimals);
  }
}

}  // namespace

const char* quality_word(control::PoseQuality quality) {
  switch (quality) {
    case control::PoseQuality::kGood:
      return "good";
    case control::PoseQuality::kDoubtful:
      return "doubtful";
    case control::PoseQuality::kLost:
      return "lost";
  }
  return "unknown";
}

std::string path_csv(const planning::Trajectory& trajectory) {
  std::string out = "t_s,x_m,y_m,yaw_rad,v_m_s,w_rad_s,curvature_1_m\n";
  for (const auto& p : trajectory.points) {
    append_row(out, {p.time_s, p.pose.x, p.pose.y, p.pose.phi, p.speed_m_s, p.yaw_rate_rad_s,
                     p.curvature_1_m});
    out += '\n';
  }
  return out;
}

void write_path_csv(const std::filesystem::path& csv, const planning::Trajectory& trajectory) {
  maps::write_file_atomically(csv, std::string_view(path_csv(trajectory)));
}

std::string drive_csv(const control::DriveLog& log) {
  std::string out =
      "t_s,true_x_m,true_y_m,true_yaw_rad,estimated_x_m,estimated_y_m,estimated_yaw_rad,"
      "command_v_m_s,command_w_rad_s,true_v_m_s,true_w_rad_s,reference_t_s,reference_x_m,"
      "reference_y_m,reference_yaw_rad,reference_v_m_s,reference_w_rad_s,heading_error_rad,"
      "cross_track_error_m,sigma_position_m,pose_quality\n";
  for (const auto& s : log.steps) {
    const auto& r = s.reference;
    append_row(out, {s.time_s,
                     s.true_pose.x,
                     s.true_pose.y,
                     s.true_pose.phi,
                     s.estimated_pose.x,
                     s.estimated_pose.y,
                     s.estimated_pose.phi,
                     s.command.vx,
                     s.command.omega,
                     s.true_twist.vx,
                     s.true_twist.omega,
                     r.time_s,
                     r.pose.x,
                     r.pose.y,
                     r.pose.phi,
                     r.speed_m_s,
                     r.yaw_rate_rad_s,
                     s.heading_error_rad,
                     s.cross_track_error_m,
                     s.sigma_position_m});
    out += ',';
    out += quality_word(s.quality);
    out += '\n';
  }
  return out;
}

std::string trajectory_tum(const control::DriveLog& log, WhichPose which) {
  std::string out = which == WhichPose::kTrue
                        ? "# map_from_base_link, true: t tx ty tz qx qy qz qw\n"
                        : "# map_from_base_link, estimated: t tx ty tz qx qy qz qw\n";
  for (const auto& s : log.steps) {
    const TPose2D& p = which == WhichPose::kTrue ? s.true_pose : s.estimated_pose;
    if (!maps::is_finite(p)) continue;
    out += fixed(s.time_s, kDecimals) + ' ' + fixed(p.x, kDecimals) + ' ' + fixed(p.y, kDecimals) +
           " 0 0 0 " + fixed(std::sin(p.phi / 2), 9) + ' ' + fixed(std::cos(p.phi / 2), 9) + '\n';
  }
  return out;
}

}  // namespace rovigo::app
