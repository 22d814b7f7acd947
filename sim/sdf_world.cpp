// Reads worlds from SDF files. The one place that knows libsdformat, whose headers are heavy.

#include <optional>
#include <sdf/sdf.hh>
#include <system_error>

#include "maps/error.h"
#include "sim/marker_texture.h"
#include "sim/world.h"
#include "sim/world_model.h"

namespace rovigo::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxFileBytes = 16U << 20U;
constexpr std::size_t kMaxSolids = 20000;
constexpr double kMaxExtentM = 1000.0;
constexpr char kStartFrame[] = "rover_start";
constexpr char kTexturePrefix[] = "Rovigo/";

/// Walks the tree and collects solids; every message starts with the file's name.
class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  WorldModel read() {
    sdf::Console::Instance()->SetQuiet(true);  // a library prints nothing
    sdf::Root root;
    const sdf::Errors errors = root.Load(file_);
    if (!errors.empty()) fail("not a usable SDF file: " + errors.front().Message());
    if (root.WorldCount() != 1) {
      fail("an SDF world file holds exactly one <world>, this one holds " +
           std::to_string(root.WorldCount()));
    }
    const sdf::World& world = *root.WorldByIndex(0);
    model_.name = world.Name();
    for (std::uint64_t i = 0; i < world.ModelCount(); ++i) read_model(*world.ModelByIndex(i));
    if (model_.solids.empty()) fail("the world has no surfaces; give it at least a ground plane");
    model_.start = read_start(world);
    return std::move(model_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw maps::InputError(file_ + ": " + what);
  }

  Eigen::Isometry3d resolve(const sdf::SemanticPose& pose, const std::string& to,
                            const std::string& what) const {
    gz_pose out;
    const sdf::Errors errors = pose.Resolve(out, to);
    if (!errors.empty()) fail(what + ": the <pose> does not resolve: " + errors.front().Message());
    return isometry(out, what);
  }

  using gz_pose = ignition::math::Pose3d;

  Eigen::Isometry3d isometry(const gz_pose& p, const std::string& what) const {
    if (!p.IsFinite() || p.Pos().Length() > kMaxExtentM) {
      fail(what + ": the <pose> is not within " + std::to_string(int(kMaxExtentM)) +
           " m of its parent");
    }
    Eigen::Isometry3d m = Eigen::Isometry3d::Identity();
    m.linear() =
        Eigen::Quaterniond(p.Rot().W(), p.Rot().X(), p.Rot().Y(), p.Rot().Z()).toRotationMatrix();
    m.translation() = Eigen::Vector3d(p.Pos().X(), p.Pos().Y(), p.Pos().Z());
    return m;
  }

  void read_model(const sdf::Model& model) {
    const std::string what = "model '" + model.Name() + "'";
    if (!model.Static()) fail(what + " is not <static>; only static models are supported");
    if (model.ModelCount() > 0) fail(what + " holds another model; nesting is not supported");
    const auto world_from_model = resolve(model.SemanticPose(), "world", what);
    for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
      const sdf::Link& link = *model.LinkByIndex(i);
      const std::string name = model.Name() + "::" + link.Name();
      const auto model_from_link = resolve(link.SemanticPose(), "__model__", "link '" + name + "'");
      read_link(link, name, world_from_model * model_from_link);
    }
  }

  void read_link(const sdf::Link& link, const std::string& name,
                 const Eigen::Isometry3d& world_from_link) {
    const bool own_collisions = link.CollisionCount() > 0;
    for (std::uint64_t i = 0; i < link.VisualCount(); ++i) {
      const sdf::Visual& visual = *link.VisualByIndex(i);
      const std::string what = name + "::" + visual.Name();
      Solid solid = read_geometry(visual.Geom(), what);
      solid.world_from_solid =
          world_from_link * resolve(visual.SemanticPose(), link.Name(), "visual '" + what + "'") *
          solid.world_from_solid;
      solid.material = read_material(visual.Material(), what);
      solid.touchable = !own_collisions;
      add(std::move(solid));
    }
    for (std::uint64_t i = 0; i < link.CollisionCount(); ++i) {
      const sdf::Collision& collision = *link.CollisionByIndex(i);
      const std::string what = name + "::" + collision.Name();
      Solid solid = read_geometry(collision.Geom(), what);
      solid.world_from_solid =
          world_from_link *
          resolve(collision.SemanticPose(), link.Name(), "collision '" + what + "'") *
          solid.world_from_solid;
      solid.visible = false;
      add(std::move(solid));
    }
  }

  void add(Solid solid) {
    if (model_.solids.size() >= kMaxSolids) {
      fail("more than " + std::to_string(kMaxSolids) + " surfaces");
    }
    model_.solids.push_back(std::move(solid));
  }

  Solid read_geometry(const sdf::Geometry* geometry, const std::string& what) const {
    Solid solid;
    solid.name = what;
    if (geometry && geometry->BoxShape()) {
      const auto s = geometry->BoxShape()->Size();
      solid.size = {s.X(), s.Y(), s.Z()};
    } else if (geometry && geometry->CylinderShape()) {
      const auto& c = *geometry->CylinderShape();
      solid.kind = Solid::Kind::kCylinder;
      solid.size = {2.0 * c.Radius(), 2.0 * c.Radius(), c.Length()};
    } else if (geometry && geometry->PlaneShape()) {
      const auto& p = *geometry->PlaneShape();
      solid.kind = Solid::Kind::kPlane;
      solid.size = {p.Size().X(), p.Size().Y(), 1.0};
      const Eigen::Vector3d n(p.Normal().X(), p.Normal().Y(), p.Normal().Z());
      solid.world_from_solid.linear() =
          Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), n).toRotationMatrix();
    } else {
      fail("'" + what + "': unsupported <geometry>; use box, cylinder or plane");
    }
    for (int i = 0; i < 3; ++i) {
      if (!(solid.size[i] > 0.0 && solid.size[i] <= kMaxExtentM)) {
        fail("'" + what + "': size " + std::to_string(solid.size[i]) + " m is outside (0, " +
             std::to_string(int(kMaxExtentM)) + "]");
      }
    }
    return solid;
  }

  Material read_material(const sdf::Material* material, const std::string& what) const {
    Material out;
    out.seed = name_seed(what);
    if (!material) return out;
    const auto c = material->Diffuse();
    out.color = {c.R(), c.G(), c.B()};
    const std::string script = material->ScriptName();
    if (script.empty()) return out;
    if (const auto id = marker_id(script)) {
      out.pattern = Pattern::kMarker;
      out.seed = *id;
      return out;
    }
    std::string known;
    for (const auto& [name, pattern] : pattern_names()) {
      if (script == kTexturePrefix + name) {
        out.pattern = pattern;
        return out;
      }
      known += (known.empty() ? "" : ", ") + (kTexturePrefix + name);
    }
    fail("'" + what + "': unknown material script '" + script + "'; known: " + known +
         ", Rovigo/Marker0 to Rovigo/Marker49");
  }

  /// "Rovigo/Marker7": the ArUco marker 7.
  static std::optional<std::uint32_t> marker_id(const std::string& script) {
    const std::string prefix = std::string(kTexturePrefix) + "Marker";
    if (script.rfind(prefix, 0) != 0) return std::nullopt;
    const std::string digits = script.substr(prefix.size());
    if (digits.empty() || digits.size() > 2 ||
        digits.find_first_not_of("0123456789") != std::string::npos) {
      return std::nullopt;
    }
    const auto id = static_cast<std::uint32_t>(std::stoul(digits));
    if (id >= kMarkerIds) return std::nullopt;
    return id;
  }

  /// The rover is put down at the <frame name="rover_start">; without one at the origin.
  TPose2D read_start(const sdf::World& world) const {
    const sdf::Frame* frame = world.FrameByName(kStartFrame);
    if (!frame) return {};
    const auto pose = resolve(frame->SemanticPose(), "world", "frame 'rover_start'");
    const Eigen::Vector3d forward = pose.linear().col(0);
    return {pose.translation().x(), pose.translation().y(), std::atan2(forward.y(), forward.x())};
  }

  std::string file_;
  WorldModel model_;
};

}  // namespace

World World::load(const fs::path& sdf_file) {
  std::error_code error;
  const auto bytes = fs::file_size(sdf_file, error);
  if (error) {
    throw maps::InputError(sdf_file.string() + ": cannot read this world: " + error.message());
  }
  if (bytes > kMaxFileBytes) {
    throw maps::InputError(sdf_file.string() + ": " + std::to_string(bytes) +
                           " bytes are too many for a world file; the limit is " +
                           std::to_string(kMaxFileBytes));
  }
  return World(Reader(sdf_file.string()).read());
}

}  // namespace rovigo::sim
