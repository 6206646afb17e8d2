#include "tendril/io/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "tendril/io/diagnostics.hpp"

namespace tendril::io {
namespace {

[[noreturn]] void fail(const std::string& path, int code) {
  throw FileError(path + ": cannot write: " + std::strerror(code));
}

int write_all(int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

}  // namespace

void write_file(const std::string& path, std::string_view content) {
  struct stat info {};
  const bool exists = ::stat(path.c_str(), &info) == 0;
  if (exists && S_ISDIR(info.st_mode)) fail(path, EISDIR);
  if (exists && !S_ISREG(info.st_mode)) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (file < 0) fail(path, errno);
    const int code = write_all(file, content);
    if (::close(file) != 0 && code == 0) fail(path, errno);
    if (code != 0) fail(path, code);
    return;
  }
  // A symbolic link keeps pointing where it did: its target is what gets replaced.
  std::error_code no_link;
  const std::filesystem::path target = exists ? std::filesystem::canonical(path, no_link) : std::filesystem::path(path);
  const std::string final_name = no_link ? path : target.string();
  const std::string temporary = final_name + ".part" + std::to_string(::getpid());
  const int file =
      ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, exists ? info.st_mode & 0777 : 0666);
  if (file < 0) fail(path, errno);
  int code = write_all(file, content);
  if (code == 0 && ::fsync(file) != 0) code = errno;
  if (::close(file) != 0 && code == 0) code = errno;
  if (code == 0 && std::rename(temporary.c_str(), final_name.c_str()) != 0) code = errno;
  if (code != 0) {
    ::unlink(temporary.c_str());
    fail(path, code);
  }
}

void make_directory(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw FileError(path + ": cannot create the directory: " + error.message());
  if (!std::filesystem::is_directory(path)) throw FileError(path + ": is not a directory");
}

}  // namespace tendril::io
