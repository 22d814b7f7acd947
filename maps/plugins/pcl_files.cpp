#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <stdexcept>

#include "maps/plugins/writers.h"

namespace rovigo::maps {
namespace {

pcl::PointCloud<pcl::PointXYZRGB> to_pcl(Points points) {
  pcl::PointCloud<pcl::PointXYZRGB> cloud;
  cloud.reserve(points.size());
  for (const ColoredPoint& p : points) cloud.emplace_back(p.x, p.y, p.z, p.r, p.g, p.b);
  return cloud;
}

}  // namespace

void write_ply(Points points, FileName file) {
  if (pcl::io::savePLYFileBinary(file, to_pcl(points)) != 0) {
    throw std::runtime_error("PCL could not write the PLY file");
  }
}

void write_pcd(Points points, FileName file) {
  if (pcl::io::savePCDFileBinaryCompressed(file, to_pcl(points)) != 0) {
    throw std::runtime_error("PCL could not write the PCD file");
  }
}

}  // namespace rovigo::maps
