#pragma once
// Objects of a rawlog, read without trusting them.

#include <mrpt/serialization/CSerializable.h>

#include "slam/recording/gz_archive.h"

namespace rovigo::slam {

/// The next object of the stream. MRPT's own reading believes every length in the file (4 GB
/// strings) and ends the process on a damaged JPEG, so the kinds that recordings are made of, in
/// the versions that MRPT 2 writes, are read here with limits: RGB-D, IMU, odometry, comments and
/// sensory frames of them. A colour image that does not decode leaves its observation without one.
/// All else is left to MRPT. Throws a standard exception where the bytes are no object.
mrpt::serialization::CSerializable::Ptr read_rawlog_object(GzReadArchive& archive);

}  // namespace rovigo::slam
