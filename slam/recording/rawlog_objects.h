#pragma once
// Objects of a rawlog, read without trusting them.

#include <mrpt/serialization/CSerializable.h>

#include "slam/recording/gz_archive.h"

namespace rovigo::slam {

/// The next object of the stream. MRPT's own reading believes every length in the file (4 GB
/// strings) and ends the process on a damaged JPEG, so the kinds that recordings are made of, in
/// the versions that MRPT 2 writes, are read here with limits: RGB-D, IMU, odometry, comments and
/// sensory frames of them. A colour image that does not decode leaves its observation without one.
/// All else (2D scans, robot actions, what MRPT 1 wrote) is left to MRPT, which a hostile file can
/// still crash. Throws a standard exception where the bytes are no object.
mrpt::serialization::CSerializable::Ptr read_rawlog_object(GzReadArchive& archive);

/// The next object as MRPT reads it: any kind it knows, believed as it stands.
mrpt::serialization::CSerializable::Ptr read_with_mrpt(GzReadArchive& archive);

}  // namespace rovigo::slam
