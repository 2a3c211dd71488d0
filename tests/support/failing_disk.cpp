#include "tests/support/failing_disk.hpp"

#include "stats/random.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <fstream>

namespace grainsweep::tests {

struct FailingDisk::State {
    sqlite3_vfs* real = nullptr;
    sqlite3_vfs vfs{};
    std::vector<Event> events;
    std::int64_t count = 0, fail_at = 0;
    Fault fault = Fault::input_output;
    Calls calls = Calls::changes;
    bool from_then_on = false, failed = false;

    [[nodiscard]] bool fails(Calls kind = Calls::changes) {
        if (fail_at == 0 || kind != calls) return false;
        ++count;
        const bool now = from_then_on ? count >= fail_at : count == fail_at;
        failed = failed || now;
        if (now && fault == Fault::killed) (void)std::raise(SIGKILL);
        return now;
    }
};

namespace {

FailingDisk::State* current = nullptr;  // SQLite's callbacks have no other way to it

struct File {
    sqlite3_file base;
    char name[64];
    // the real file lies behind
    sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
};

File& self(sqlite3_file* file) {
    return *reinterpret_cast<File*>(file);
}

using Event = FailingDisk::Event;
constexpr auto looks = FailingDisk::Calls::looks;

int failure(int otherwise) {
    return current->fault == FailingDisk::Fault::full ? SQLITE_FULL : otherwise;
}

int x_close(sqlite3_file* file) {
    return self(file).real()->pMethods->xClose(self(file).real());
}
int x_read(sqlite3_file* file, void* into, int n, sqlite3_int64 at) {
    if (current->fails(looks)) return SQLITE_IOERR_READ;
    return self(file).real()->pMethods->xRead(self(file).real(), into, n, at);
}
int x_write(sqlite3_file* file, const void* from, int n, sqlite3_int64 at) {
    if (current->fails()) return failure(SQLITE_IOERR_WRITE);
    const auto* bytes = static_cast<const std::byte*>(from);
    current->events.push_back({Event::Kind::write, self(file).name, at, std::vector(bytes, bytes + n)});
    return self(file).real()->pMethods->xWrite(self(file).real(), from, n, at);
}
int x_truncate(sqlite3_file* file, sqlite3_int64 size) {
    if (current->fails()) return failure(SQLITE_IOERR_TRUNCATE);
    current->events.push_back({Event::Kind::truncate, self(file).name, size, {}});
    return self(file).real()->pMethods->xTruncate(self(file).real(), size);
}
int x_sync(sqlite3_file* file, int flags) {
    if (current->fails()) return failure(SQLITE_IOERR_FSYNC);
    current->events.push_back({Event::Kind::sync, self(file).name, 0, {}});
    return self(file).real()->pMethods->xSync(self(file).real(), flags);
}
int x_size(sqlite3_file* file, sqlite3_int64* size) {
    if (current->fails(looks)) return SQLITE_IOERR_FSTAT;
    return self(file).real()->pMethods->xFileSize(self(file).real(), size);
}
int x_lock(sqlite3_file* file, int kind) {
    if (current->fails(looks)) return SQLITE_IOERR_LOCK;
    return self(file).real()->pMethods->xLock(self(file).real(), kind);
}
int x_unlock(sqlite3_file* file, int kind) {
    return self(file).real()->pMethods->xUnlock(self(file).real(), kind);
}
int x_check_lock(sqlite3_file* file, int* out) {
    return self(file).real()->pMethods->xCheckReservedLock(self(file).real(), out);
}
int x_control(sqlite3_file* file, int code, void* argument) {
    return self(file).real()->pMethods->xFileControl(self(file).real(), code, argument);
}
int x_sector(sqlite3_file* file) {
    return self(file).real()->pMethods->xSectorSize(self(file).real());
}
int x_characteristics(sqlite3_file*) {
    return 0;
}  // promises nothing: no atomic, no ordered writes
int x_shm_map(sqlite3_file* file, int page, int size, int extend, void volatile** out) {
    if (current->fails(looks)) return SQLITE_IOERR_SHMMAP;
    return self(file).real()->pMethods->xShmMap(self(file).real(), page, size, extend, out);
}
int x_shm_lock(sqlite3_file* file, int offset, int n, int flags) {
    const bool taking = (flags & SQLITE_SHM_LOCK) != 0;  // giving a lock back does not fail
    if (taking && current->fails(looks)) return SQLITE_IOERR_SHMLOCK;
    return self(file).real()->pMethods->xShmLock(self(file).real(), offset, n, flags);
}
void x_shm_barrier(sqlite3_file* file) {
    self(file).real()->pMethods->xShmBarrier(self(file).real());
}
int x_shm_unmap(sqlite3_file* file, int remove) {
    return self(file).real()->pMethods->xShmUnmap(self(file).real(), remove);
}

const sqlite3_io_methods methods = {
    2,           x_close,      x_read,    x_write,  x_truncate,        x_sync,    x_size,     x_lock,
    x_unlock,    x_check_lock, x_control, x_sector, x_characteristics, x_shm_map, x_shm_lock, x_shm_barrier,
    x_shm_unmap, nullptr,      nullptr};

std::string base_name(const char* path) {
    return path == nullptr ? "unnamed" : std::filesystem::path(path).filename().string();
}

int x_open(sqlite3_vfs*, const char* path, sqlite3_file* file, int flags, int* out_flags) {
    file->pMethods = nullptr;
    if (current->fails(looks)) return SQLITE_CANTOPEN;
    const int code = current->real->xOpen(current->real, path, self(file).real(), flags, out_flags);
    if (code != SQLITE_OK) return code;
    std::strncpy(self(file).name, base_name(path).c_str(), sizeof(File::name) - 1);
    file->pMethods = &methods;
    return SQLITE_OK;
}

int x_access(sqlite3_vfs*, const char* path, int flags, int* out) {
    if (current->fails(looks)) return SQLITE_IOERR_ACCESS;
    return current->real->xAccess(current->real, path, flags, out);
}

int x_delete(sqlite3_vfs*, const char* path, int sync_folder) {
    if (current->fails()) return failure(SQLITE_IOERR_DELETE);
    current->events.push_back({Event::Kind::remove, base_name(path), 0, {}});
    return current->real->xDelete(current->real, path, sync_folder);
}

void apply(std::vector<std::byte>& contents, const Event& event) {
    const auto offset = static_cast<std::size_t>(event.offset);
    if (event.kind == Event::Kind::truncate) {
        contents.resize(std::min(contents.size(), offset));
        return;
    }
    if (contents.size() < offset + event.bytes.size()) contents.resize(offset + event.bytes.size());
    std::ranges::copy(event.bytes, contents.begin() + static_cast<std::ptrdiff_t>(offset));
}

/// Of a write the sectors that reached the disk.
void apply_torn(std::vector<std::byte>& contents, const Event& event, const stats::Stream& chance,
                std::uint64_t& draw) {
    constexpr std::size_t sector = 512;
    if (event.kind == Event::Kind::truncate) {
        if (chance.uniform(draw++) < 0.5) apply(contents, event);
        return;
    }
    for (std::size_t from = 0; from < event.bytes.size(); from += sector) {
        if (chance.uniform(draw++) < 0.5) continue;
        const auto first = event.bytes.begin() + static_cast<std::ptrdiff_t>(from);
        const auto length = std::min(sector, event.bytes.size() - from);
        apply(contents, {Event::Kind::write, event.file, event.offset + static_cast<std::int64_t>(from),
                         std::vector(first, first + static_cast<std::ptrdiff_t>(length))});
    }
}

}  // namespace

FailingDisk::FailingDisk() : state_(std::make_unique<State>()) {
    state_->real = sqlite3_vfs_find(nullptr);
    state_->vfs = *state_->real;
    state_->vfs.zName = "failing-disk";
    state_->vfs.szOsFile = static_cast<int>(sizeof(File)) + state_->real->szOsFile;
    state_->vfs.xOpen = x_open;
    state_->vfs.xDelete = x_delete;
    state_->vfs.xAccess = x_access;
    current = state_.get();
    sqlite3_vfs_register(&state_->vfs, 1);
}

FailingDisk::~FailingDisk() {
    sqlite3_vfs_unregister(&state_->vfs);
    sqlite3_vfs_register(state_->real, 1);
    current = nullptr;
}

void FailingDisk::fail_at(std::int64_t n, Fault fault, bool from_then_on, Calls calls) {
    state_->calls = calls;
    state_->count = 0;
    state_->fail_at = n;
    state_->fault = fault;
    state_->from_then_on = from_then_on;
    state_->failed = false;
}
void FailingDisk::work_again() {
    state_->fail_at = 0;
}
bool FailingDisk::has_failed() const {
    return state_->failed;
}
const std::vector<Event>& FailingDisk::events() const {
    return state_->events;
}
void FailingDisk::acknowledge(std::int64_t number) {
    state_->events.push_back({Event::Kind::acknowledge, {}, number, {}});
}

Disk after_power_loss(const std::vector<Event>& events, std::size_t count, Unsynced unsynced, std::uint64_t seed) {
    Disk disk;
    std::map<std::string, std::vector<const Event*>> pending;
    const auto settle = [&](const std::string& file) {
        for (const auto* event : pending[file]) apply(disk[file], *event);
        pending[file].clear();
    };
    for (std::size_t k = 0; k < count; ++k) {
        const auto& event = events[k];
        switch (event.kind) {
            case Event::Kind::write:
            case Event::Kind::truncate:
                pending[event.file].push_back(&event);
                break;
            case Event::Kind::sync:
                settle(event.file);
                break;
            case Event::Kind::remove:
                disk.erase(event.file);
                pending.erase(event.file);
                break;
            case Event::Kind::acknowledge:
                break;
        }
    }
    const stats::Stream chance(seed, count);
    std::uint64_t draw = 0;
    for (auto& [file, writes] : pending) {
        if (unsynced == Unsynced::lost) break;
        for (const auto* event : writes) {
            unsynced == Unsynced::kept ? apply(disk[file], *event) : apply_torn(disk[file], *event, chance, draw);
        }
    }
    return disk;
}

void write_disk(const Disk& disk, const std::filesystem::path& folder) {
    for (const auto& [file, contents] : disk) {
        std::ofstream stream(folder / file, std::ios::binary);
        stream.write(reinterpret_cast<const char*>(contents.data()), static_cast<std::streamsize>(contents.size()));
    }
}

}  // namespace grainsweep::tests
