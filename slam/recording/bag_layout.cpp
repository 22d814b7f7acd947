#include "slam/recording/bag_layout.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "maps/error.h"
#include "slam/recording/rig_yaml.h"
#include "slam/recording/text_file.h"

namespace rovigo::slam {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool has_any(const std::string& text, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(), [&text](std::string_view word) {
    return text.find(word) != std::string::npos;
  });
}

std::string parent_of(const std::string& topic) { return topic.substr(0, topic.rfind('/')); }

/// Parts that two topics begin with: /camera/color and /camera/depth share one.
int shared_parts(const std::string& a, const std::string& b) {
  int parts = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()) && a[i] == b[i]; ++i) {
    parts += a[i] == '/' && i > 0;
  }
  return parts;
}

class LayoutChoice {
 public:
  LayoutChoice(const BagSurvey& survey, std::string bag) : survey_(survey), bag_(std::move(bag)) {}

  BagLayout choose(const std::optional<std::filesystem::path>& camera_info);

 private:
  using Candidate = std::pair<std::string, int>;  ///< topic, how likely

  int color_score(const std::string& topic, const BagImageTopic& image) const;
  int depth_score(const std::string& topic, const BagImageTopic& image) const;
  int rate_score(const BagImageTopic& image, bool is_depth) const;
  void choose_images();
  [[noreturn]] void fail_without(const std::string& what) const;
  void choose_cameras(const std::optional<std::filesystem::path>& camera_info);
  const BagCameraInfo* camera_info_of(const std::string& topic) const;
  mrpt::img::TCamera camera_from(const BagCameraInfo& info, const std::string& topic) const;
  void place_depth();
  void place_camera();
  void choose_imu();
  std::optional<mrpt::poses::CPose3D> base_from(const std::string& frame) const;
  void choose_wheels();

  const BagSurvey& survey_;
  std::string bag_;
  BagLayout layout_;
  std::string base_;  ///< the rover's frame; empty when unknown
};

BagLayout LayoutChoice::choose(const std::optional<std::filesystem::path>& camera_info) {
  choose_images();
  choose_cameras(camera_info);
  place_depth();
  place_camera();
  choose_imu();
  choose_wheels();
  return layout_;
}

int LayoutChoice::color_score(const std::string& topic, const BagImageTopic& image) const {
  const std::string name = lower(topic);
  int score = image.kind == BagImageKind::kColor ? 100 : 50;
  if (has_any(name, {"rgb", "color", "colour"})) score += 20;
  if (has_any(name, {"infra", "/ir", "fisheye", "depth", "disparity", "confidence"})) score -= 60;
  const bool is_left = has_any(name, {"infra1", "infrared_1", "left"});
  if (image.kind == BagImageKind::kGrey && is_left) score += 3;  // RealSense sees depth from there
  if (has_any(name, {"aligned_color"})) score -= 10;
  if (has_any(name, {"rect"})) score += 2;
  if (!image.is_compressed) score += 1;  // the same image twice: without losses
  return score + rate_score(image, false);
}

int LayoutChoice::depth_score(const std::string& topic, const BagImageTopic& image) const {
  const std::string name = lower(topic);
  int score = 100;
  if (has_any(name, {"aligned_depth_to_color", "depth_registered", "depth_to_rgb"})) score += 30;
  if (has_any(name, {"depth"})) score += 20;
  if (has_any(name, {"infra", "/ir", "disparity", "confidence"})) score -= 60;
  if (has_any(name, {"rect"})) score += 2;
  if (!image.is_compressed) score += 1;
  return score + rate_score(image, true);
}

/// A stream at less than half the rate of another of its kind is a preview.
int LayoutChoice::rate_score(const BagImageTopic& image, bool is_depth) const {
  std::uint64_t most = 0;
  for (const auto& [topic, other] : survey_.images) {
    if ((other.kind == BagImageKind::kDepth) == is_depth) most = std::max(most, other.messages);
  }
  return image.messages > 0 && image.messages * 2 < most ? -40 : 0;
}

void LayoutChoice::choose_images() {
  std::vector<Candidate> colors;
  std::vector<Candidate> depths;
  for (const auto& [topic, image] : survey_.images) {
    if (image.kind == BagImageKind::kDepth) {
      depths.emplace_back(topic, depth_score(topic, image));
    } else if (image.kind != BagImageKind::kOther) {
      colors.emplace_back(topic, color_score(topic, image));
    }
  }
  if (colors.empty()) fail_without("colour images (rgb8, bgr8, mono8, or compressed)");
  if (depths.empty()) fail_without("depth images (16UC1 or 32FC1, or compressedDepth)");
  int best = 0;
  std::string rival;
  for (const auto& [color, color_points] : colors) {
    for (const auto& [depth, depth_points] : depths) {
      const int score = color_points + depth_points + 4 * shared_parts(color, depth);
      if (score == best) rival = color == layout_.color_topic ? depth : color;
      if (score <= best) continue;
      best = score;
      rival.clear();
      layout_.color_topic = color;
      layout_.depth_topic = depth;
    }
  }
  if (layout_.color_topic.empty()) fail_without("colour and depth images that go together");
  if (rival.empty()) return;
  const bool is_depth = survey_.images.at(rival).kind == BagImageKind::kDepth;
  throw maps::InputError(
      bag_ + ": the topics " + shown_text(is_depth ? layout_.depth_topic : layout_.color_topic) +
      " and " + shown_text(rival) + " could both be the " + (is_depth ? "depth" : "colour") +
      " camera; leave one out with rosbag filter");
}

void LayoutChoice::fail_without(const std::string& what) const {
  constexpr std::size_t kMost = 12;
  std::string topics;
  std::size_t count = 0;
  for (const auto& [topic, type] : survey_.types) {
    if (count++ == kMost) break;
    const auto image = survey_.images.find(topic);
    const std::string& kind = image == survey_.images.end() ? type : image->second.encoding;
    topics += (topics.empty() ? "" : ", ") + shown_text(topic) + " (" + shown_text(kind) + ")";
  }
  if (survey_.types.size() > kMost) {
    topics += " and " + std::to_string(survey_.types.size() - kMost) + " more";
  }
  throw maps::InputError(bag_ + ": no topic holds " + what + "; " +
                         (topics.empty() ? "there is no topic at all" : "its topics: " + topics));
}

void LayoutChoice::choose_cameras(const std::optional<std::filesystem::path>& camera_info) {
  const BagImageTopic& color = survey_.images.at(layout_.color_topic);
  const BagImageTopic& depth = survey_.images.at(layout_.depth_topic);
  const BagCameraInfo* const color_info = camera_info_of(layout_.color_topic);
  const BagCameraInfo* const depth_info = camera_info_of(layout_.depth_topic);
  if (camera_info) {
    layout_.rig.camera = read_camera_info(*camera_info);
  } else if (color_info != nullptr) {
    layout_.rig.camera = camera_from(*color_info, layout_.color_topic);
  } else {
    throw maps::InputError(bag_ + ": there is no camera_info for " +
                           shown_text(layout_.color_topic) +
                           ", so the camera's calibration is unknown; give --camera-info FILE");
  }
  const bool is_same_size = color.width == depth.width && color.height == depth.height;
  const bool is_told_apart = depth_info != nullptr && depth_info != color_info;
  if (is_told_apart && !(camera_info && depth.frame == color.frame)) {
    layout_.depth_camera = camera_from(*depth_info, layout_.depth_topic);
  } else if (is_same_size) {
    layout_.depth_camera = layout_.rig.camera;
  } else {
    throw maps::InputError(
        bag_ + ": there is no camera_info for " + shown_text(layout_.depth_topic) +
        ", whose images are of another size (" + std::to_string(depth.width) + " x " +
        std::to_string(depth.height) + ") than the colour images (" + std::to_string(color.width) +
        " x " + std::to_string(color.height) + ")");
  }
}

const BagCameraInfo* LayoutChoice::camera_info_of(const std::string& topic) const {
  const std::string stream = realsense_stream_of(topic);
  const bool is_compressed = survey_.images.at(topic).is_compressed;
  const std::string image_topic = is_compressed ? parent_of(topic) : topic;
  for (const std::string& name :
       {stream + "/info/camera_info", parent_of(image_topic) + "/camera_info"}) {
    const auto found = survey_.camera_infos.find(name);
    if (found != survey_.camera_infos.end()) return &found->second;
  }
  const BagImageTopic& image = survey_.images.at(topic);
  const BagCameraInfo* only = nullptr;
  for (const auto& [name, info] : survey_.camera_infos) {
    const bool fits =
        info.stamp.frame == image.frame && info.width == image.width && info.height == image.height;
    if (!fits) continue;
    if (only != nullptr && only->k != info.k) return nullptr;  // two that contradict each other
    only = &info;
  }
  return only;
}

mrpt::img::TCamera LayoutChoice::camera_from(const BagCameraInfo& info,
                                             const std::string& topic) const {
  const std::string last = topic.substr(topic.rfind('/') + 1);
  const bool is_rectified =
      has_any(last, {"rect"}) ||
      has_any(parent_of(topic).substr(parent_of(topic).rfind('/') + 1), {"rect"});
  std::string problem;
  const auto camera = camera_of(info, is_rectified, problem);
  if (!camera) {
    throw maps::InputError(bag_ + ": the camera_info of " + shown_text(topic) +
                           " cannot be used: " + problem + "; --camera-info FILE overrides it");
  }
  return *camera;
}

/// Where depth is seen from. The same frame, or a name that says so, means that it is registered.
void LayoutChoice::place_depth() {
  const BagImageTopic& color = survey_.images.at(layout_.color_topic);
  const BagImageTopic& depth = survey_.images.at(layout_.depth_topic);
  const std::string sensor = parent_of(realsense_stream_of(layout_.depth_topic));
  const auto units = survey_.depth_units_m.find(sensor);
  if (units != survey_.depth_units_m.end()) layout_.depth_units_m = units->second;
  const bool is_same_size = layout_.depth_camera.ncols == layout_.rig.camera.ncols &&
                            layout_.depth_camera.nrows == layout_.rig.camera.nrows;
  const bool is_registered =
      depth.frame == color.frame ||
      has_any(layout_.depth_topic, {"aligned_depth_to_color", "depth_registered"});
  if (is_registered && is_same_size) {
    layout_.depth_camera = layout_.rig.camera;
    return;
  }
  if (is_registered) return;  // the same view in another resolution
  if (const auto pose = survey_.frames.find(color.frame, depth.frame)) {
    layout_.color_from_depth = *pose;
    return;
  }
  const std::string frames = "depth is seen from " + shown_text(depth.frame) + ", colour from " +
                             shown_text(color.frame) + ", and no transform says how they sit";
  if (!is_same_size) throw maps::InputError(bag_ + ": " + frames + " on each other");
  layout_.depth_camera = layout_.rig.camera;
  layout_.warnings.push_back(bag_ + ": " + frames +
                             " on each other; depth is taken as registered to colour.");
}

void LayoutChoice::place_camera() {
  Rig& rig = layout_.rig;
  rig.base_from_camera = base_from_optical(mrpt::poses::CPose3D());
  const std::string& camera = survey_.images.at(layout_.color_topic).frame;
  for (const char* name : {"base_link", "base_footprint"}) {
    const auto pose = survey_.frames.find(name, camera);
    if (!pose) continue;
    base_ = name;
    rig.base_from_camera = *pose;
    rig.has_extrinsics = true;
    return;
  }
  if (survey_.frames.contains("base_link")) {
    layout_.warnings.push_back(bag_ + ": no transform leads from base_link to the camera's frame " +
                               shown_text(camera) + "; the camera is taken as the body.");
  }
}

std::optional<mrpt::poses::CPose3D> LayoutChoice::base_from(const std::string& frame) const {
  if (!base_.empty()) {
    if (auto pose = survey_.frames.find(base_, frame)) return pose;
  }
  const std::string& camera = survey_.images.at(layout_.color_topic).frame;
  const auto camera_from_frame = survey_.frames.find(camera, frame);
  if (!camera_from_frame) return std::nullopt;
  return layout_.rig.base_from_camera + *camera_from_frame;
}

void LayoutChoice::choose_imu() {
  BagImuSource best;
  int best_score = 0;
  for (const auto& [rate_topic, rate] : survey_.imus) {
    for (const auto& [force_topic, force] : survey_.imus) {
      if (!rate.has_rate || !force.has_force) continue;
      const auto base_from_rate = base_from(rate.frame);
      const auto base_from_force = base_from(force.frame);
      const bool is_placed = base_from_rate && base_from_force;
      const int score = 1 + (is_placed ? 8 : 0) + (rate_topic == force_topic ? 4 : 0) +
                        std::min(shared_parts(rate_topic, force_topic), 2);
      if (score <= best_score) continue;
      best_score = score;
      best = {rate_topic, force_topic, base_from_rate.value_or(mrpt::poses::CPose3D()),
              base_from_force.value_or(mrpt::poses::CPose3D())};
      if (!is_placed) best_score = std::min(best_score, 7);
    }
  }
  if (best_score == 0) {
    if (survey_.imus.empty()) return;
    layout_.warnings.push_back(bag_ + ": " + shown_text(survey_.imus.begin()->first) +
                               " holds no turn rates or no accelerations; it is left out.");
    return;
  }
  const bool is_placed = best_score >= 8;
  const std::string where =
      bag_ + ": no transform says how the IMU of " + shown_text(best.rate_topic) + " is mounted; ";
  if (!is_placed && !layout_.rig.has_extrinsics) {
    layout_.warnings.push_back(where + "it is left out.");
    return;
  }
  if (!is_placed) layout_.warnings.push_back(where + "its axes are taken as those of base_link.");
  layout_.rig.has_imu = true;
  layout_.imu = best;
}

/// Odometry of wheels, not of cameras, and never a motion-capture system's: that is the truth.
void LayoutChoice::choose_wheels() {
  int best_score = -1;
  for (const auto& [topic, odometry] : survey_.odometries) {
    const std::string name = lower(topic);
    if (has_any(name, {"truth", "/gt", "mocap", "vicon", "optitrack", "gps", "visual", "vio",
                       "vins", "slam", "rtabmap", "rgbd", "icp", "camera"})) {
      continue;
    }
    int score = 0;
    if (has_any(name, {"wheel", "encoder"})) score += 30;
    if (name.ends_with("odom") || name.ends_with("odometry")) score += 10;
    if (has_any(name, {"filtered", "ekf", "combined"})) score -= 5;
    if (score < 0 || score <= best_score) continue;
    best_score = score;
    layout_.wheel_topic = topic;
  }
  layout_.rig.has_wheels = layout_.wheel_topic.has_value();
}

}  // namespace

BagLayout choose_layout(const BagSurvey& survey, const std::string& bag,
                        const std::optional<std::filesystem::path>& camera_info) {
  return LayoutChoice(survey, bag).choose(camera_info);
}

}  // namespace rovigo::slam
