/* One browser at the web socket: what he gets next, and when he has enough for now.
 *
 * A page says how many messages it has drawn (got). More than `window` messages are
 * never on the way to it: a slow page, or one in a hidden tab, skips to the newest state instead of
 * falling behind, and what it skipped is counted. One that looks at the past gets what it asks for, and of
 * now the link alone. Web thread only. */
#ifndef CONSOLE_CLIENT_H
#define CONSOLE_CLIENT_H

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "operator/console/board.h"
#include "operator/console/commander.h"
#include "operator/console/messages.h"
#include "operator/console/recordings/open_recording.h"
#include "operator/console/recordings/recorder.h"

namespace console
{

/* What a page sees and asks of the console's recordings. */
struct Recordings {
    std::function<RecorderState()> state = [] { return RecorderState(); };
    /* False: not now. What comes of it is told later, by Client::answer. */
    std::function<bool(const PageMessage &)> ask = [](const PageMessage &) { return false; };
};

/* The robots of the console, as a page sees them that shows one. */
struct Company {
    std::string robot; /* that it shows */
    std::function<std::vector<RobotTold>()> told = [] { return std::vector<RobotTold>(); };
    std::function<Sent()> stop_all = [] { return Sent(); };
};

class Client
{
  public:
    static constexpr uint64_t window = 32;

    using Command = std::function<Sent(const std::vector<std::string> &words)>;

    /* operator_name: in whose name it commands; empty: it cannot. */
    Client(const Board &board, std::string operator_name, Command command, Recordings recordings = {},
           Company company = {})
        : board_(board), operator_name_(std::move(operator_name)), command_(std::move(command)),
          recordings_(std::move(recordings)), company_(std::move(company))
    {
    }

    /* The next message to send, if there is one and the page keeps up. */
    std::optional<std::string> next(Board::Clock::time_point now);

    /* A link report is due (sent four times a second, also when nothing else is). */
    void link_due();

    /* A message from the page. False: not one that a page sends. */
    bool heard(const std::string &text);

    /* What has come of something that the page asked for: a message, or a recording, which is shown from its
     * beginning on until the page asks for now again; not where it has asked for something else since. */
    void answer(std::string message);
    void show(std::shared_ptr<const OpenRecording> recording, const std::string &name);

    uint64_t skipped() const
    {
        return skipped_;
    }

  private:
    static constexpr size_t trail_points_a_message = 2000;

    std::optional<std::string> choose(Board::Clock::time_point now);
    std::string greet();
    std::optional<std::string> next_report(Board::Clock::time_point now);
    std::optional<std::string> next_topic();
    std::optional<std::string> next_trail();

    /* Answers that a page has not fetched yet; more, and it is no page that waits for them. */
    static constexpr size_t most_answers = 64;
    static constexpr size_t series_points = 600;

    bool got(uint64_t count);
    bool look(std::optional<int64_t> at_ms);
    bool tell_series();
    bool command(const std::vector<std::string> &words);
    bool stop_all();
    bool ask(const PageMessage &message);
    void answered();
    Past look_back(int64_t at_ms) const;
    History::Span span() const;
    std::vector<History::Text> sample(Topic topic) const;

    const Board &board_;
    std::string operator_name_;
    Command command_;
    Recordings recordings_;
    Company company_;
    std::vector<RobotTold> told_; /* what it knows of the company */
    std::deque<std::string> answers_;
    size_t asked_ = 0;                               /* what the page asked for, and has no answer yet */
    std::shared_ptr<const OpenRecording> recording_; /* that is shown; nullptr: the robot is */
    std::string recording_name_;
    std::string wanted_name_; /* that the page asked for last; empty: it asked for now since */
    bool looks_back_ = false;
    std::deque<std::string> past_; /* what is still to be sent of where he looks */
    uint64_t life_ = 0;            /* the robot's life that the page was told of */
    bool link_due_ = true;
    bool company_due_ = false;
    uint64_t sent_ = 0;
    uint64_t drawn_ = 0;
    uint64_t skipped_ = 0;
    size_t turn_ = 0; /* topic to look at first: each has its turn */
    std::array<uint64_t, topic_count> seen_{};
    uint64_t trail_epoch_ = 0;
    size_t trail_next_ = 0;
};

} // namespace console

#endif
