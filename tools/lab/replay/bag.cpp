#include "lab/replay/bag.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <sys/wait.h>
#include <unistd.h>

namespace ale
{

namespace
{

namespace fs = std::filesystem;

constexpr char converter[] = "ale-foxglove";

bool begins_with(const std::string &path, const std::string &magic)
{
    std::ifstream file(path, std::ios::binary);
    std::string begin(magic.size(), '\0');
    file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    return file && begin == magic;
}

/* Beside this program, else in the PATH. */
std::string converter_path()
{
    std::error_code error;
    const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / converter;
    return !error && fs::exists(beside, error) ? beside.string() : converter;
}

/* What it says on its standard error goes to the writing end. */
[[noreturn]] void become_converter(const std::string &from, const std::string &to, int messages)
{
    const std::string program = converter_path();
    dup2(messages, STDERR_FILENO);
    execlp(program.c_str(), converter, "convert", from.c_str(), to.c_str(), static_cast<char *>(nullptr));
    const std::string words = program + ", which reads bags, cannot be run: " + std::strerror(errno) + "\n";
    const ssize_t written = write(STDERR_FILENO, words.c_str(), words.size());
    _exit(written < 0 ? 126 : 127);
}

std::string last_line(const std::string &text)
{
    const size_t end = text.find_last_not_of('\n');
    const size_t begin = end == std::string::npos ? end : text.rfind('\n', end);
    return end == std::string::npos ? "" : text.substr(begin + 1, end - begin);
}

std::string read_all(int descriptor)
{
    std::string text;
    std::array<char, 512> piece{};
    for (ssize_t count; (count = read(descriptor, piece.data(), piece.size())) > 0;) {
        text.append(piece.data(), static_cast<size_t>(count));
    }
    return text;
}

} // namespace

bool is_bag(const std::string &path)
{
    std::error_code error;
    if (fs::is_directory(path, error)) {
        return fs::exists(fs::path(path) / "metadata.yaml", error);
    }
    /* Of a pipe nothing may be read here. */
    return fs::is_regular_file(path, error) &&
           (begins_with(path, "#ROSBAG V2.0") || begins_with(path, "\x89MCAP0\r\n"));
}

LogFile::LogFile(const std::string &path) : given_(path)
{
    if (!is_bag(path)) {
        return;
    }
    std::string name = (fs::temp_directory_path() / "ale-replay-XXXXXX").string();
    if (!mkdtemp(name.data())) {
        throw std::runtime_error(name + ": " + std::strerror(errno));
    }
    folder_ = name;
    converted_ = name + "/bag.lcm";
    try {
        convert();
    } catch (...) {
        fs::remove_all(folder_);
        throw;
    }
}

void LogFile::convert()
{
    int ends[2];
    if (pipe(ends) < 0) {
        throw std::runtime_error(std::string("no pipe: ") + std::strerror(errno));
    }
    const pid_t child = fork();
    if (child == 0) {
        become_converter(given_, converted_, ends[1]);
    }
    close(ends[1]);
    const std::string said = child > 0 ? read_all(ends[0]) : "no process for it";
    close(ends[0]);
    int status = -1;
    if (child < 0 || waitpid(child, &status, 0) < 0 || status != 0) {
        throw std::runtime_error(given_ + ": " + last_line(said));
    }
}

LogFile::~LogFile()
{
    if (!folder_.empty()) {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }
}

} // namespace ale
