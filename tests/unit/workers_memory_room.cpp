// Memory that a process can have, read from a folder that stands for the machine.
#include "sweep/workers/memory_room.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace grainsweep::tests::workers_memory_room_test {

namespace fs = std::filesystem;

class MemoryRoom : public testing::Test {
protected:
    MemoryRoom() { fs::remove_all(root_); }
    ~MemoryRoom() override { fs::remove_all(root_); }
    void put(const std::string& path, const std::string& text) const {
        fs::create_directories((root_ / path).parent_path());
        std::ofstream(root_ / path) << text;
    }
    [[nodiscard]] double room() const { return workers::memory_room(root_.string()); }

private:
    fs::path root_ = fs::path(testing::TempDir()) / "memory_room";
};

TEST_F(MemoryRoom, IsTheMachinesMemory) {
    EXPECT_TRUE(std::isinf(room())) << "nothing can be read";
    put("proc/meminfo", "MemTotal:       16000 kB\nMemFree:  5 kB\n");
    EXPECT_EQ(room(), 16000 * 1024.0);
}

TEST_F(MemoryRoom, IsTheLeastLimitOfTheGroupsAbove) {
    put("proc/meminfo", "MemTotal:       16000 kB\n");
    put("proc/self/cgroup", "0::/job/step\n");
    put("sys/fs/cgroup/job/step/memory.max", "max\n");
    put("sys/fs/cgroup/job/memory.max", "1000000\n");
    EXPECT_EQ(room(), 1e6);
    put("sys/fs/cgroup/job/step/memory.max", "900000\n");
    EXPECT_EQ(room(), 9e5);
}

TEST_F(MemoryRoom, ReadsGroupsOfTheFirstVersion) {
    put("proc/meminfo", "MemTotal:       16000 kB\n");
    put("proc/self/cgroup", "5:cpu,cpuacct:/job\n4:memory:/job\n");
    put("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "2000000\n");
    put("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
    EXPECT_EQ(room(), 2e6);
}

}  // namespace grainsweep::tests::workers_memory_room_test
