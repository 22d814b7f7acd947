#include <octomap/octomap.h>

#include <fstream>
#include <stdexcept>

#include "maps/plugins/writers.h"

namespace rovigo::maps {
namespace {

constexpr double kMaxRange = 6.0;  // the camera's; farther returns are clutter

void save(octomap::OcTree& tree, FileName file) {
  tree.toMaxLikelihood();
  tree.prune();
  // The header is written here because OctoMap's own function for it prints to the terminal.
  std::ofstream out(file, std::ios::binary);
  out << "# Octomap OcTree binary file\nid " << tree.getTreeType() << "\nsize " << tree.size()
      << "\nres " << tree.getResolution() << "\ndata\n";
  if (tree.size() > 0) tree.writeBinaryData(out);
  out.flush();
  if (!out) throw std::runtime_error("OctoMap could not write the file");
}

}  // namespace

void write_octomap(NextViewPoints next, double resolution_m, FileName file) {
  octomap::OcTree tree(resolution_m);
  ViewPoints view;
  while (next(view)) {
    octomap::Pointcloud cloud;
    cloud.reserve(view.points.size());
    for (const ColoredPoint& p : view.points) cloud.push_back(p.x, p.y, p.z);
    const octomap::point3d origin(static_cast<float>(view.camera.x),
                                  static_cast<float>(view.camera.y),
                                  static_cast<float>(view.camera.z));
    // Discretised: each leaf is updated once a view, however many points fall into it.
    tree.insertPointCloud(cloud, origin, kMaxRange, true, true);
  }
  tree.updateInnerOccupancy();
  save(tree, file);
}

void write_octomap_layer(const OccupancyGrid& grid, FileName file) {
  octomap::OcTree tree(grid.geometry.resolution_m);
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (OccupancyGrid::is_unknown(grid.cells[i])) continue;
    const TPoint2D c = grid.geometry.center_of(grid.geometry.cell_of(i));
    const octomap::point3d at(static_cast<float>(c.x), static_cast<float>(c.y),
                              static_cast<float>(0.5 * grid.geometry.resolution_m));
    tree.updateNode(at, OccupancyGrid::is_occupied(grid.cells[i]), true);
  }
  tree.updateInnerOccupancy();
  save(tree, file);
}

}  // namespace rovigo::maps
