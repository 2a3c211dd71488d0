// Memory that a process can have, read from a folder that stands for the machine.
#include "sweep/workers/memory_room.hpp"
#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace grainsweep::tests::workers_memory_room_test {

class MemoryRoom : public testing::Test {
protected:
    void put(const std::string& path, const std::string& text) const {
        std::filesystem::create_directories((root_ / path).parent_path());
        root_.write(path, text);
    }
    [[nodiscard]] double room() const { return workers::memory_room(root_.path().string()); }

private:
    Folder root_;
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
