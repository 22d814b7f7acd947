#include "maps/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <stdexcept>

#include "maps/error.h"
#include "tests/unit/maps/test_support.h"

namespace rovigo::maps {
namespace {

using test::bytes_of;
using test::put_bytes;
using test::ScratchFolder;

TEST(AtomicFile, WritesBytesAsTheyAre) {
  const ScratchFolder folder;
  const std::string bytes("a\0b\n\xff", 5);
  write_file_atomically(folder / "out", bytes);
  EXPECT_EQ(bytes_of(folder / "out"), bytes);
  EXPECT_EQ(folder.count_entries(), 1u);
}

TEST(AtomicFile, ReplacesTheOldFileAndKeepsItsPermissions) {
  const ScratchFolder folder;
  put_bytes(folder / "out", "old");
  ASSERT_EQ(::chmod((folder / "out").c_str(), 0640), 0);
  write_file_atomically(folder / "out", "new");
  EXPECT_EQ(bytes_of(folder / "out"), "new");
  struct stat info = {};
  ASSERT_EQ(::stat((folder / "out").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 07777, 0640u);
}

TEST(AtomicFile, SymbolicLinkStaysALink) {
  const ScratchFolder folder;
  put_bytes(folder / "real", "old");
  std::filesystem::create_symlink("real", folder / "link");
  write_file_atomically(folder / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(bytes_of(folder / "real"), "new");
}

TEST(AtomicFile, MissingFolderIsOneClearSentence) {
  const ScratchFolder folder;
  try {
    write_file_atomically(folder / "nowhere/out", "x");
    FAIL() << "no error";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("nowhere/out"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("No such file"), std::string::npos);
  }
}

TEST(AtomicFile, FolderAsTargetIsRefused) {
  const ScratchFolder folder;
  EXPECT_THROW(write_file_atomically(folder.path(), "x"), InputError);
}

TEST(AtomicFile, FullDiskLeavesTheOldFileAndNoTrace) {
  const ScratchFolder folder;
  put_bytes(folder / "out", "old");
  // A file-size limit stands in for a full disk: write() fails just as it would.
  rlimit old_limit = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  const rlimit small = {1000, old_limit.rlim_max};
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(write_file_atomically(folder / "out", std::string(5000, 'x')), InputError);
  ::setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(bytes_of(folder / "out"), "old");
  EXPECT_EQ(folder.count_entries(), 1u);
}

TEST(AtomicFile, WriterThatThrowsLeavesTheOldFileAndNoTrace) {
  const ScratchFolder folder;
  put_bytes(folder / "out", "old");
  const auto write = [](const std::filesystem::path& temporary) {
    put_bytes(temporary, "half");
    throw std::runtime_error("stop");
  };
  EXPECT_THROW(write_file_atomically(folder / "out", write), std::runtime_error);
  EXPECT_EQ(bytes_of(folder / "out"), "old");
  EXPECT_EQ(folder.count_entries(), 1u);
}

TEST(AtomicFile, DeviceIsWrittenTo) { EXPECT_NO_THROW(write_file_atomically("/dev/null", "x")); }

TEST(ReadFile, ReadsBackWhatWasWritten) {
  const ScratchFolder folder;
  const std::string bytes(200000, 'q');
  put_bytes(folder / "in", bytes);
  EXPECT_EQ(read_file(folder / "in", 200000), bytes);
}

TEST(ReadFile, RefusesTooLargeMissingAndFolder) {
  const ScratchFolder folder;
  put_bytes(folder / "in", "12345");
  EXPECT_THROW(read_file(folder / "in", 4), InputError);
  EXPECT_THROW(read_file(folder / "none", 4), InputError);
  EXPECT_THROW(read_file(folder.path(), 4), InputError);
  EXPECT_THROW(read_file("/dev/zero", 100000), InputError);
}

}  // namespace
}  // namespace rovigo::maps
