#include "file_io.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <burin/image_io.hpp>

namespace burin {
namespace {

// Closes on every way out.
class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return fd_; }
    // Errors of the last write may show up here only (network file systems, quotas).
    bool close() {
        const int fd = fd_;
        fd_ = -1;
        return ::close(fd) == 0;
    }

  private:
    int fd_;
};

Status write_all(const std::string& path, std::span<const std::uint8_t> bytes) {
    Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (file.get() < 0) return file_error("cannot write", path);
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t n = ::write(file.get(), bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return file_error("cannot write", path);
        done += static_cast<std::size_t>(n);
    }
    if (!file.close()) return file_error("cannot write", path);
    return Done{};
}

// A name that no other process and no other call of this one uses.
std::string temporary_name(const std::string& path) {
    static std::uint32_t calls = 0;
    const std::uint32_t call = __atomic_add_fetch(&calls, 1u, __ATOMIC_RELAXED);
    return path + "." + std::to_string(::getpid()) + "." + std::to_string(call) + ".tmp";
}

}  // namespace

Error file_error(const std::string& what, const std::string& path) {
    const int number = errno;
    return Error{ErrorCode::io_failed, what + " '" + path + "': " + std::strerror(number)};
}

Status write_atomically(const std::string& path, const std::function<Status(const std::string&)>& write) {
    struct stat state {};
    if (::stat(path.c_str(), &state) == 0 && !S_ISREG(state.st_mode)) {
        if (S_ISDIR(state.st_mode))
            return Error{ErrorCode::io_failed, "cannot write '" + path + "': it is a folder"};
        return write(path);
    }
    const std::string temporary = temporary_name(path);
    Status status = write(temporary);
    if (status.ok() && std::rename(temporary.c_str(), path.c_str()) != 0)
        status = file_error("cannot write", path);
    if (!status.ok()) {
        ::unlink(temporary.c_str());
        // The user knows the target's name, not the temporary one's.
        Error error = status.error();
        if (const auto at = error.message.find(temporary); at != std::string::npos)
            error.message.replace(at, temporary.size(), path);
        return error;
    }
    return status;
}

Status write_file(const std::string& path, std::span<const std::uint8_t> bytes) {
    return write_atomically(path, [&](const std::string& name) { return write_all(name, bytes); });
}

Result<std::vector<std::uint8_t>> read_file(const std::string& path, std::uint64_t max_bytes) {
    // Not blocking: opening a pipe must not wait for a writer before its kind is known.
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.get() < 0) return file_error("cannot open", path);
    struct stat state {};
    if (::fstat(file.get(), &state) != 0) return file_error("cannot read", path);
    if (!S_ISREG(state.st_mode))
        return Error{ErrorCode::io_failed, "cannot read '" + path + "': it is not a regular file"};
    const auto size = static_cast<std::uint64_t>(state.st_size);
    if (size > max_bytes)
        return Error{ErrorCode::limit_exceeded, "'" + path + "' has " + std::to_string(size) +
                                                    " bytes, limit " + std::to_string(max_bytes)};
    std::vector<std::uint8_t> bytes(size);
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t n = ::read(file.get(), bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return file_error("cannot read", path);
        if (n == 0) break;  // it shrank while being read
        done += static_cast<std::size_t>(n);
    }
    bytes.resize(done);
    return bytes;
}

}  // namespace burin
