// Apart from the other reading, so that the fuzzer can put a refusal in its place: MRPT's own
// deserialisation does not survive hostile bytes.
#include "slam/recording/rawlog_objects.h"

namespace rovigo::slam {

mrpt::serialization::CSerializable::Ptr read_with_mrpt(GzReadArchive& archive) {
  return archive.ReadObject();
}

}  // namespace rovigo::slam
