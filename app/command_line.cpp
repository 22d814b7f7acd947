#include "app/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/commands/options.h"
#include "app/console.h"
#include "maps/error.h"

namespace rovigo::app {

namespace {

void add_common(CLI::App& command, CommonOptions& options) {
  command.add_option("--config", options.config, "YAML file with settings (see `rovigo config`)");
  command.add_option("--set", options.set, "One setting, e.g. robot.max_speed_m_s=0.3; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_flag("--json", options.json, "Print one JSON object on stdout instead of words");
}

void add_route(CLI::App& command, RouteRequest& route) {
  command.add_option("--start", route.start, "X,Y[,YAW]; default: the recording's first pose");
  command.add_option("--goal", route.goal, "X,Y[,YAW] in metres and radians, map frame");
  command.add_option("--via", route.via, "X,Y to pass on the way; repeatable")
      ->allow_extra_args(false);
  command.add_option("--order", route.order, "Order of the stops: given or shortest")
      ->check(CLI::IsMember({"given", "shortest"}));
  command.add_option("--planner", route.planner,
                     "astar, thetastar, rrtconnect, rrtstar, bitstar or prmstar");
  command.add_option("--map-mode", route.map_mode,
                     "0 only known-free ground, 1 unknown ground too, 2 everything is passable");
}

/// The subcommand that was chosen, and how to run it.
using Action = std::function<int()>;

template <class Options>
std::shared_ptr<Options> bind(CLI::App& command, int (*run)(const Options&), Action& chosen,
                              bool& json) {
  auto options = std::make_shared<Options>();
  add_common(command, *options);
  command.callback([options, run, &chosen, &json] {
    json = options->json;
    chosen = [options, run] { return run(*options); };
  });
  return options;
}

void add_recording_commands(CLI::App& app, Action& chosen, bool& json) {
  CLI::App* record = app.add_subcommand(
      "record", "Drive the simulated rover along a route and record its sensors");
  auto r = bind(*record, run_record, chosen, json);
  record
      ->add_option("--world", r->world, "World: a name in sim/worlds, random:SEED, or an SDF file")
      ->required();
  record
      ->add_option("--route", r->route,
                   "Route: a name in sim/routes, a YAML file, or one made for the world: "
                   "loop:METRES[:SEED[:LAPS]] a closed tour, turns:METRES[:SEED] one that turns in "
                   "place at every stop, spin:X,Y,YAW[:RATE[:SECONDS]] turning on one spot")
      ->required();
  record->add_option("-o,--output", r->output, "The .rawlog to write")->required();
  record->add_option("--seed", r->seed, "Seed of all noise");
  record->add_option("--scenario", r->scenario,
                     "Sensors, faults: a name in sim/scenarios or a YAML file");
  record->add_option("--fps", r->fps, "Camera frames per second")->check(CLI::Range(1.0, 60.0));
  record->add_option("--tum", r->tum, "Also write a TUM directory");
  record->add_option("--truth", r->truth, "Write the true poses and grid, apart, into this folder");

  CLI::App* map = app.add_subcommand("map", "Turn a recording into a map file");
  auto m = bind(*map, run_map, chosen, json);
  map->add_option("recording", m->recording, "A .rawlog or a TUM directory")->required();
  map->add_option("-o,--output", m->output, "The map file to write, NAME.rovigo")->required();
  map->add_option("--trajectory", m->trajectory, "Also write the trajectory, TUM format");
  map->add_option("--frame", m->frame, "Frame of the trajectory")
      ->check(CLI::IsMember({"base_link", "camera"}));
  map->add_option("--camera-info", m->camera_info,
                  "ROS camera_info YAML, where the recording has no intrinsics");

  CLI::App* localize =
      app.add_subcommand("localize", "Find and follow the pose of a recording in a saved map");
  auto l = bind(*localize, run_localize, chosen, json);
  localize->add_option("map", l->map, "The map file")->required();
  localize->add_option("recording", l->recording, "A .rawlog or a TUM directory")->required();
  localize->add_option("--trajectory", l->trajectory, "Also write the trajectory, TUM format");
  localize->add_option("--health", l->health,
                       "Also write health, confidence and pose of every frame, CSV");
  localize->add_option("--frame", l->frame, "Frame of the trajectory")
      ->check(CLI::IsMember({"base_link", "camera"}));
  localize->add_option("--camera-info", l->camera_info, "ROS camera_info YAML");
}

void add_driving_commands(CLI::App& app, Action& chosen, bool& json) {
  CLI::App* plan = app.add_subcommand("plan", "Plan a path and a timed trajectory on a map");
  auto p = bind(*plan, run_plan, chosen, json);
  plan->add_option("map", p->map, "A .rovigo, a ROS map .yaml or a MovingAI .map")->required();
  add_route(*plan, p->route);
  plan->add_flag("--point", p->point, "Plan a point on the raw grid: no inflation, no smoothing");
  plan->add_option("--batch", p->batch,
                   "Many queries: CSV start_x,start_y,goal_x,goal_y or a MovingAI .scen");
  plan->add_option("--path", p->path, "Write the timed trajectory as CSV");
  plan->add_option("--image", p->image, "Draw the plan as PNG");
  plan->add_option("--seed", p->seed, "Seed of the sampling planners");

  CLI::App* drive = app.add_subcommand("drive", "Plan, then drive it in the simulator");
  auto d = bind(*drive, run_drive, chosen, json);
  drive->add_option("map", d->map, "A .rovigo, a ROS map .yaml or a MovingAI .map")->required();
  add_route(*drive, d->route);
  drive->add_option("--world", d->world,
                    "World to drive in; default: the map's own, or walls from its cells");
  drive->add_option("--scenario", d->scenario,
                    "Sensors, faults: a name in sim/scenarios or a YAML file");
  drive->add_option("--pose", d->pose, "Pose source")
      ->check(CLI::IsMember({"slam", "odometry", "perturbed", "truth"}));
  drive->add_option("--seed", d->seed, "Seed of all noise");
  drive->add_option("--report", d->report, "Write a report folder to open in a browser");
}

void add_dock_command(CLI::App& app, Action& chosen, bool& json) {
  CLI::App* dock =
      app.add_subcommand("dock", "Stop before an ArUco marker that the simulated camera sees");
  auto d = bind(*dock, run_dock, chosen, json);
  dock->footer(
      "Speed comes from a PI whose integrator is switched on only near the dock. It helps against "
      "a "
      "steady hindrance (stiction, a slope against the rover); not where the hindrance pushes the "
      "rover on, and not where it holds the rover outside docking.box_m.\n"
      "  rovigo dock --world dock --report docking\n"
      "  rovigo dock --world dock --set docking.box_m=100 --set docking.box_rate_m_s=100   a plain "
      "PI");
  dock->add_option("--world", d->world,
                   "World with a marker: dock, another name in sim/worlds, or an SDF file")
      ->required();
  dock->add_option("--marker", d->marker, "The marker's id; default: the only one in the world")
      ->check(CLI::Range(0, 49));
  dock->add_option("--start", d->start,
                   "X,Y[,YAW] in the world, facing the marker; default: where rovers are put down");
  dock->add_option("--scenario", d->scenario,
                   "Sensors, faults: a name in sim/scenarios or a YAML file");
  dock->add_option("--seed", d->seed, "Seed of all noise");
  dock->add_option("--report", d->report, "Write a report folder to open in a browser");
}

void add_track_command(CLI::App& app, Action& chosen, bool& json) {
  CLI::App* track =
      app.add_subcommand("track", "Repeatable trajectory-tracking tests in the simulator");
  auto t = bind(*track, run_track, chosen, json);
  track->footer(
      "A suite file names trajectories, disturbances, speeds, seeds, controllers and limits; "
      "sim/suites/default.yaml shows every key. Exit code 1: a run missed its limits.\n"
      "  rovigo track --report tests\n"
      "  rovigo track mine.yaml --against tests/track.json --report after\n"
      "  rovigo track missions --shard 3/8 --report part3       on each of eight machines, then\n"
      "  rovigo track --merge part*/track.json --report all");
  track->add_option("suite", t->suite, "A name in sim/suites or a YAML file; default: default");
  track->add_option("--pose", t->pose, "Pose source of every run, whatever the suite says")
      ->check(CLI::IsMember({"perturbed", "truth", "slam", "odometry"}));
  track->add_option("--shard", t->shard, "Drive only share I of N of the runs")->type_name("I/N");
  track
      ->add_option("--merge", t->merge,
                   "Put together what shards with --json printed; for a report, their track.json")
      ->type_name("FILES...");
  track->add_option("--report", t->report,
                    "Write a report folder to open in a browser; shards' reports can be merged");
  track->add_option("--against", t->against,
                    "Compare with this earlier track.json or --json; with --report run by run");
  track->add_option("--threads", t->threads, "Default: as many as the machine has")
      ->check(CLI::Range(1, 1024));
}

void add_tuning_commands(CLI::App& app, Action& chosen, bool& json) {
  CLI::App* tune = app.add_subcommand("tune", "Find controller gains for the simulated rover");
  auto t = bind(*tune, run_tune, chosen, json);
  tune->footer(
      "relay: a relay makes each loop oscillate; the gains come from the Ziegler-Nichols table. "
      "Quick (seconds), and rough.\n"
      "optimise: tries gains on the suite and keeps what drives best. Minutes.\n"
      "Both print what the suite measures before and after, also on seeds that nothing was tuned "
      "on. The same command gives the same gains, whatever the threads.\n"
      "  rovigo tune --out gains.yaml\n"
      "  rovigo track --config gains.yaml --report tests\n"
      "  rovigo tune mine.yaml --method relay --scenario late_poses --set robot.track_width_m=0.4");
  tune->add_option("suite", t->suite, "A name in sim/suites or a YAML file; default: tuning");
  tune->add_option("--method", t->method, "optimise (default) or relay")
      ->check(CLI::IsMember({"optimise", "relay"}));
  tune->add_option("--scenario", t->scenario,
                   "Of the relay experiment: a name in sim/scenarios or a YAML file");
  tune->add_option("--pose", t->pose, "Pose source of every run, whatever the suite says")
      ->check(CLI::IsMember({"perturbed", "truth"}));
  tune->add_option("--evaluations", t->evaluations,
                   "Most settings that optimise tries; default 120")
      ->check(CLI::Range(1, 100000));
  tune->add_option("--seed", t->seed, "Of the directions that optimise tries");
  tune->add_option("--threads", t->threads, "Default: as many as the machine has")
      ->check(CLI::Range(1, 1024));
  tune->add_option("--out", t->out, "Write the gains as YAML for --config");

  CLI::App* identify =
      app.add_subcommand("identify", "First-order models from logged set-points and responses");
  auto i = bind(*identify, run_identify, chosen, json);
  identify->footer(
      "The log is a CSV with a header: a drive's drive.csv (forward speed and turn rate are found "
      "in it), or the columns time_s,setpoint,response. Steps may be uneven; an empty response was "
      "not measured then.\n"
      "  rovigo drive lab.rovigo --goal 10,-3.5 --report report\n"
      "  rovigo identify report/drive.csv --report fit.html");
  identify->add_option("log", i->log, "The log, CSV")->required();
  identify->add_option("--setpoint", i->setpoint, "Its column of set-points, by name");
  identify->add_option("--response", i->response, "Its column of responses, by name");
  identify->add_option("--report", i->report, "Write a page that shows log and model, HTML");
}

void add_file_commands(CLI::App& app, Action& chosen, bool& json) {
  CLI::App* info =
      app.add_subcommand("info", "What a recording or a map holds; rescues damaged maps");
  auto i = bind(*info, run_info, chosen, json);
  info->add_option("file", i->file, "A map or a recording")->required();
  info->add_option("--recover", i->recover, "Write what is whole in a damaged map to this file");

  CLI::App* exporter = app.add_subcommand("export", "Write a map for other tools");
  auto e = bind(*exporter, run_export, chosen, json);
  exporter->add_option("map", e->map, "The map file")->required();
  exporter
      ->add_option(
          "--format", e->format,
          "ros, png, ply, pcd, octomap, gridmap, simplemap, trajectory, geojson or keepout")
      ->required();
  exporter->add_option("-o,--output", e->output, "The main file; companions lie beside it")
      ->required();

  CLI::App* importer =
      app.add_subcommand("import", "Turn a ROS map.yaml or MovingAI .map into a map file");
  auto m = bind(*importer, run_import, chosen, json);
  importer->add_option("source", m->source, "The map to import")->required();
  importer->add_option("-o,--output", m->output, "The map file to write, NAME.rovigo")->required();
}

void add_checking_commands(CLI::App& app, Action& chosen, bool& json) {
  CLI::App* evaluate = app.add_subcommand("evaluate", "Compare an estimate with the truth");
  evaluate->require_subcommand(1);
  CLI::App* trajectory =
      evaluate->add_subcommand("trajectory", "ATE, RPE and coverage of a TUM-format trajectory");
  auto t = bind(*trajectory, run_evaluate_trajectory, chosen, json);
  trajectory->add_option("estimate", t->estimate, "Estimated trajectory")->required();
  trajectory->add_option("truth", t->truth, "True trajectory")->required();
  CLI::App* map = evaluate->add_subcommand("map", "Precision, recall and IoU of a map's grid");
  auto m = bind(*map, run_evaluate_map, chosen, json);
  map->add_option("map", m->map, "The map file")->required();
  map->add_option("truth", m->truth, "The true grid, a ROS map .yaml in the world frame")
      ->required();

  CLI::App* config =
      app.add_subcommand("config", "Every setting, its unit, range and default; checks a file");
  auto c = bind(*config, run_config, chosen, json);
  config->add_option("--check", c->check, "Check this YAML file and say what is wrong with it");
  config->add_flag("--markdown", c->markdown, "Print app/SETTINGS.md");
}

/// One clear sentence on stderr and, with --json, the same as an object on stdout.
int report_error(const std::string& sentence, const char* status, bool json) {
  std::fprintf(stderr, "rovigo: error: %s\n", sentence.c_str());
  if (json) {
    nlohmann::ordered_json object{{"status", status}, {"code", kBadInput}, {"message", sentence}};
    Console(true).result(object, "", {});
  }
  return kBadInput;
}

bool asks_for_json(int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--json") return true;
  }
  return false;
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  CLI::App app{"Rovigo: record a lab, map it, click a goal, drive there.", "rovigo"};
  app.set_version_flag("--version", std::string("rovigo ") + ROVIGO_VERSION);
  app.require_subcommand(1);
  Action chosen;
  bool json = false;
  add_recording_commands(app, chosen, json);
  add_driving_commands(app, chosen, json);
  add_dock_command(app, chosen, json);
  add_track_command(app, chosen, json);
  add_tuning_commands(app, chosen, json);
  add_file_commands(app, chosen, json);
  add_checking_commands(app, chosen, json);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    std::string help = "`rovigo";
    for (const CLI::App* command : app.get_subcommands()) help += " " + command->get_name();
    return report_error(std::string(e.what()) + "; see " + help + " --help`", "bad_usage",
                        asks_for_json(argc, argv));
  }
  try {
    return chosen();
  } catch (const maps::InputError& e) {
    return report_error(e.what(), "bad_input", json);
  } catch (const std::bad_alloc&) {
    return report_error("out of memory: the input is larger than this machine can hold",
                        "bad_input", json);
  } catch (const std::exception& e) {
    return report_error(std::string("this should not have happened, please report it: ") + e.what(),
                        "internal_error", json);
  }
}

}  // namespace rovigo::app
