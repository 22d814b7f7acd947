#include <mrpt/core/Clock.h>
#include <mrpt/img/CImage.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <stdexcept>

#include "maps/mrpt_grid.h"
#include "maps/plugins/writers.h"

namespace rovigo::maps {
namespace {

/// MRPT moves a grid's limits to multiples of the resolution; ours stay where they are.
class PlacedGrid : public mrpt::maps::COccupancyGridMap2D {
 public:
  explicit PlacedGrid(const GridGeometry& g) {
    const auto resolution = static_cast<float>(g.resolution_m);
    setSize(0.0F, resolution * static_cast<float>(g.width), 0.0F,
            resolution * static_cast<float>(g.height), resolution, 0.5F);
    if (getSizeX() != static_cast<unsigned>(g.width) ||
        getSizeY() != static_cast<unsigned>(g.height)) {
      throw std::runtime_error("MRPT cannot hold a grid of this size");
    }
    m_xMin = static_cast<float>(g.origin.x);
    m_yMin = static_cast<float>(g.origin.y);
    m_xMax = static_cast<float>(g.origin.x + g.width * g.resolution_m);
    m_yMax = static_cast<float>(g.origin.y + g.height * g.resolution_m);
  }
};

template <class Object>
void write_compressed(const Object& object, FileName file) {
  mrpt::io::CFileGZOutputStream out;
  if (!out.open(file)) throw std::runtime_error("the file cannot be opened");
  auto archive = mrpt::serialization::archiveFrom(out);
  archive << object;
}

/// Columns are the sensor frame's axes (x forward, y left, z up) in the optical frame (x right, y
/// down, z forward).
mrpt::poses::CPose3D optical_from_sensor() {
  mrpt::math::CMatrixDouble33 r;
  r.setZero();
  r(2, 0) = 1.0;
  r(0, 1) = -1.0;
  r(1, 2) = -1.0;
  return mrpt::poses::CPose3D(r, mrpt::math::TPoint3D(0.0, 0.0, 0.0));
}

mrpt::obs::CObservation3DRangeScan::Ptr observation(const ExchangeView& view,
                                                    const MapMetadata& metadata) {
  auto scan = mrpt::obs::CObservation3DRangeScan::Create();
  scan->sensorLabel = "RGBD";
  scan->timestamp = mrpt::Clock::fromDouble(view.time_s);
  scan->cameraParams = metadata.camera;
  scan->cameraParamsIntensity = metadata.camera;
  const auto sensor_from_optical = -optical_from_sensor();
  scan->sensorPose = metadata.base_from_camera + optical_from_sensor();
  scan->relativePoseIntensityWRTDepth = sensor_from_optical;  // both images from one camera
  scan->range_is_depth = true;
  scan->rangeUnits = 0.001F;
  if (!view.depth_mm.empty()) {
    scan->hasRangeImage = true;
    scan->rangeImage_setSize(view.height, view.width);
    for (int y = 0; y < view.height; ++y) {
      for (int x = 0; x < view.width; ++x) {
        scan->rangeImage(y, x) = view.depth_mm[static_cast<std::size_t>(y * view.width + x)];
      }
    }
  }
  if (!view.color_jpeg.empty()) {
    mrpt::io::CMemoryStream jpeg;
    jpeg.Write(view.color_jpeg.data(), view.color_jpeg.size());
    jpeg.Seek(0);
    scan->intensityImage.loadFromStreamAsJPEG(jpeg);
    scan->hasIntensityImage = true;
    scan->intensityImageChannel = mrpt::obs::CObservation3DRangeScan::CH_VISIBLE;
  }
  return scan;
}

}  // namespace

void write_gridmap(const OccupancyGrid& grid, FileName file) {
  PlacedGrid placed(grid.geometry);
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    const Cell c = grid.geometry.cell_of(i);
    placed.setCell(c.x, c.y, mrpt_free_probability(grid.cells[i]));
  }
  const mrpt::maps::COccupancyGridMap2D& as_mrpt = placed;
  const mrpt::maps::COccupancyGridMap2D plain(as_mrpt);  // serialised under MRPT's class name
  write_compressed(plain, file);
}

void write_simplemap(const MapMetadata& metadata, NextView next, FileName file) {
  mrpt::maps::CSimpleMap map;
  ExchangeView view;
  while (next(view)) {
    auto frame = mrpt::obs::CSensoryFrame::Create();
    frame->insert(observation(view, metadata));
    auto pose = mrpt::poses::CPose3DPDFGaussian::Create();
    pose->mean = view.map_from_base;
    map.insert(mrpt::poses::CPose3DPDF::Ptr(pose), frame);
  }
  write_compressed(map, file);
}

}  // namespace rovigo::maps
