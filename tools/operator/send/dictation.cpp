#include "operator/send/dictation.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include <poll.h>
#include <unistd.h>

#include "common/command_line/interrupt.h"

extern "C" {
#include "command/verb.h"
}

namespace send
{

namespace
{

constexpr int look_ms = 10;
constexpr int answer_ms = 4000;
constexpr int settle_ms = 1500; /* a robot says its status once a second */
constexpr size_t longest_line = 1000;
constexpr int64_t drive_life_us = 500000;
constexpr int64_t life_us = 5000000;

/* Lines as they come, without waiting for them. */
class Lines
{
  public:
    /* False at the end of the input. */
    bool read()
    {
        pollfd ready = {STDIN_FILENO, POLLIN, 0};
        if (poll(&ready, 1, 0) <= 0) {
            return true;
        }
        char piece[512];
        const ssize_t count = ::read(STDIN_FILENO, piece, sizeof piece);
        if (count > 0) {
            waiting_.append(piece, static_cast<size_t>(count));
        }
        return count > 0 || (count < 0 && errno == EINTR);
    }
    bool next(std::string &line)
    {
        const size_t end = waiting_.find('\n');
        if (end == std::string::npos) {
            if (waiting_.size() > longest_line) {
                throw std::runtime_error("a line without end");
            }
            return false;
        }
        line = waiting_.substr(0, end);
        waiting_.erase(0, end + 1);
        return true;
    }

  private:
    std::string waiting_;
};

void answer(bool obeyed, const std::string &words)
{
    std::printf("%s %s\n", obeyed ? "obeyed" : "refused", words.c_str());
    std::fflush(stdout);
}

ale_command_t command_of(const std::vector<std::string> &words)
{
    std::vector<const char *> texts(words.size());
    std::transform(words.begin(), words.end(), texts.begin(), [](const auto &word) { return word.c_str(); });
    ale_command_t command;
    char error[ALE_VERB_ERROR] = "too many words, or one that is too long";
    if (ale_command_from_words(texts.data(), static_cast<uint32_t>(texts.size()), &command) < 0 ||
        ale_verb_of(&command, error) < 0) {
        throw std::runtime_error(error);
    }
    return command;
}

/* Throws why nothing may be sent. A stop goes to all that are heard. */
void require_robot(const RobotLink &link, bool stop)
{
    if (!link.status()) {
        throw std::runtime_error(link.unbelieved()
                                     ? link.unbelieved()->robot + " is heard, but nobody vouches for it"
                                     : "no robot is heard");
    }
    if (!stop && !link.rival().empty()) {
        throw std::runtime_error("two robots are heard, " + link.status()->robot + " and " + link.rival() +
                                 ": which one is meant? (--robot NAME)");
    }
    if (!stop && !link.status()->takes_commands) {
        throw std::runtime_error(link.status()->robot + " takes no commands (ale-slamd --keys)");
    }
}

void obey(RobotLink &link, const std::vector<std::string> &words)
{
    const ale_command_t command = command_of(words);
    const bool driving = words[0] == "drive";
    require_robot(link, words[0] == "stop");
    link.command(command, driving ? drive_life_us : life_us);
    if (driving) {
        answer(true, "sent");
        return;
    }
    const auto answered = [&] {
        if (link.was_misled()) {
            link.command(command, life_us);
        }
        return link.answered() || cli::interrupted();
    };
    if (!link.wait(answer_ms, answered) || !link.answered()) {
        throw std::runtime_error("no answer");
    }
    answer(link.status()->command_obeyed != 0, link.status()->command_result);
}

void take_line(RobotLink &link, const std::string &line)
{
    const std::vector<std::string> words = words_of(line);
    try {
        if (words.empty()) {
            throw std::runtime_error("which verb?");
        }
        obey(link, words);
    } catch (const std::runtime_error &error) {
        answer(false, error.what());
    }
}

} // namespace

std::vector<std::string> words_of(const std::string &line)
{
    std::istringstream text(line);
    std::vector<std::string> words;
    for (std::string word; text >> word;) {
        words.push_back(word);
    }
    return words;
}

void obey_dictation(RobotLink &link, bool alone)
{
    link.wait(answer_ms, [&] { return link.status().has_value() || cli::interrupted(); });
    if (!alone) {
        link.wait(settle_ms, [&] { return !link.rival().empty() || cli::interrupted(); });
    }
    Lines lines;
    std::string line;
    bool more = true;
    while (more && !cli::interrupted()) {
        link.wait(look_ms, cli::interrupted);
        more = lines.read();
        while (!cli::interrupted() && lines.next(line)) {
            take_line(link, line);
        }
    }
}

} // namespace send
