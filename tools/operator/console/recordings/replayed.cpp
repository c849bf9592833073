#include "operator/console/recordings/replayed.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <sys/wait.h>
#include <unistd.h>

#include "operator/console/recordings/event_file.h"

namespace console
{

namespace
{

namespace fs = std::filesystem;

constexpr char program[] = "ale-replay";
constexpr uint64_t kept_free = uint64_t{32} << 20;
constexpr size_t most_words = size_t{1} << 14; /* of what it says, the last */
constexpr int look_ms = 100;                   /* whether all is to stop */
constexpr int not_run = 127;                   /* exit of a child that has not become the program */
constexpr int last_in_line = 19;               /* niceness */

[[noreturn]] void fail(const std::string &words)
{
    throw std::runtime_error(words);
}

std::string temporary_folder()
{
    std::error_code error;
    const fs::path folder = fs::temp_directory_path(error);
    return error ? "/tmp" : folder.string();
}

Descriptor nameless_file(const std::string &folder)
{
    std::string name = folder + "/ale-console-XXXXXX";
    Descriptor file(mkostemp(name.data(), O_CLOEXEC));
    if (file.number() < 0) {
        fail(folder + ": " + std::strerror(errno));
    }
    unlink(name.c_str());
    return file;
}

/* What may be written there. */
uint64_t room_of(const Descriptor &file, const std::string &folder)
{
    struct statvfs disk;
    const uint64_t free = fstatvfs(file.number(), &disk) == 0 ? uint64_t{disk.f_bavail} * disk.f_frsize : 0;
    if (free <= kept_free) {
        fail("there is no room in " + folder + " to replay it");
    }
    return free - kept_free;
}

std::string path_of(const Descriptor &file)
{
    return "/proc/self/fd/" + std::to_string(file.number());
}

/* Beside this program, else in the PATH. */
std::string program_path()
{
    std::error_code error;
    const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / program;
    return !error && fs::exists(beside, error) ? beside.string() : program;
}

/* All that the child wants to know: between fork and exec nothing may be allocated. */
struct Order {
    std::string path;
    std::string from;
    std::string to;
    int from_number;
    int to_number;
    int words; /* where what it says goes */
    rlimit room;
};

[[noreturn]] void become_replay(const Order &order)
{
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    setpriority(PRIO_PROCESS, 0, last_in_line);
    setrlimit(RLIMIT_FSIZE, &order.room);
    fcntl(order.from_number, F_SETFD, 0);
    fcntl(order.to_number, F_SETFD, 0);
    dup2(order.words, STDOUT_FILENO);
    dup2(order.words, STDERR_FILENO);
    execlp(order.path.c_str(), program, order.from.c_str(), "--lcm", order.to.c_str(),
           static_cast<char *>(nullptr));
    _exit(not_run);
}

/* What the child says, to its end; it is ended when all is to stop. */
std::string listen(const Descriptor &words, pid_t child, const std::atomic<bool> &stopping)
{
    std::string said;
    std::array<char, 512> piece{};
    pollfd wait = {words.number(), POLLIN, 0};
    while (true) {
        if (stopping) {
            kill(child, SIGKILL);
        }
        if (poll(&wait, 1, look_ms) <= 0) {
            continue;
        }
        const ssize_t count = read(words.number(), piece.data(), piece.size());
        if (count <= 0) {
            return said;
        }
        said.append(piece.data(), static_cast<size_t>(count));
        said.erase(0, said.size() - std::min(said.size(), most_words));
    }
}

/* The last line of what it said, without its own name, and the recording called by its name. */
std::string complaint(std::string said, const std::string &path, const std::string &name)
{
    said.erase(said.find_last_not_of('\n') + 1);
    std::string line = said.substr(said.rfind('\n') + 1);
    const std::string own = std::string(program) + ": ";
    if (line.compare(0, own.size(), own) == 0) {
        line.erase(0, own.size());
    }
    for (size_t at; (at = line.find(path)) != std::string::npos;) {
        line.replace(at, path.size(), name);
    }
    return line;
}

/* What it has left out, of all that it said. */
std::string damage_of(const std::string &said)
{
    unsigned long long chunks = 0;
    unsigned long long scans = 0;
    const size_t at = said.find("skipped ");
    if (at == std::string::npos ||
        std::sscanf(said.c_str() + at, "skipped %llu bad lines or chunks and %llu scans", &chunks, &scans) <
            2) {
        return "";
    }
    const std::string places = chunks > 0 ? damage_words({chunks, 0}) : "";
    const std::string larger = scans > 0 ? std::to_string(scans) + " scans of too many beams left out" : "";
    return places + (chunks > 0 && scans > 0 ? ", " : "") + larger;
}

int status_of(pid_t child)
{
    int status = -1;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

} // namespace

Replay replayed(const Descriptor &recording, const std::string &name, const std::atomic<bool> &stopping)
{
    const std::string folder = temporary_folder();
    Descriptor log = nameless_file(folder);
    const rlim_t room = room_of(log, folder);
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) < 0) {
        fail(std::string("no pipe: ") + std::strerror(errno));
    }
    const Descriptor words(ends[0]);
    Descriptor other_end(ends[1]);
    const Order order = {program_path(), path_of(recording), path_of(log), recording.number(), log.number(),
                         ends[1],        {room, room}};
    const pid_t child = fork();
    if (child == 0) {
        become_replay(order);
    }
    other_end = Descriptor();
    if (child < 0) {
        fail(std::string("no process to replay it: ") + std::strerror(errno));
    }
    const std::string said = listen(words, child, stopping);
    const int status = status_of(child);
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ) {
        fail("there is no room in " + folder + " to replay " + name);
    }
    if (WIFSIGNALED(status)) {
        fail(name + ": " + program + " was ended by signal " + std::to_string(WTERMSIG(status)));
    }
    if (WEXITSTATUS(status) == not_run) {
        fail(std::string(program) + ", which replays it, is not there");
    }
    if (status != 0) {
        fail("it cannot be replayed: " + complaint(said, order.from, name));
    }
    return {std::move(log), damage_of(said)};
}

} // namespace console
