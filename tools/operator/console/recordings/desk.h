/* Where pages ask for what lies in the console's folders: lists, the recorder's button, downloads. What may
 * wait for a disk is done by another thread, and what takes as long as a replay by a third. The serving
 * thread only. */
#ifndef CONSOLE_DESK_H
#define CONSOLE_DESK_H

#include <functional>
#include <memory>
#include <string>

#include "operator/console/messages.h"
#include "operator/console/recordings/archive.h"
#include "operator/console/recordings/downloads.h"
#include "operator/console/recordings/errands.h"
#include "operator/console/recordings/recorder.h"

namespace console
{

class Desk
{
  public:
    /* Where what comes of a request goes: a message, or a recording to look at. */
    struct Tell {
        std::function<void(std::string message)> text;
        std::function<void(std::shared_ptr<const OpenRecording> recording, const std::string &name)>
            recording;
    };

    Desk(Archive &archive, Recorder &recorder) : archive_(archive), recorder_(recorder)
    {
    }

    /* wake: makes the serving thread call hand_out(). To be closed before what it wakes is gone. */
    void open(std::function<void()> wake);
    void close();

    RecorderState recorder() const
    {
        return recorder_.state();
    }

    /* A `shelf`, `record` or `open` message of a page. False: too many wait. */
    bool ask(const PageMessage &message, Tell tell);

    /* False: too many download already. */
    bool fetch(lws *connection, const Wanted &wanted);

    void hand_out();

    Downloads &downloads()
    {
        return downloads_;
    }

  private:
    bool open_recording(const std::string &name, Tell tell);
    std::string list(const std::string &refusal);
    std::string record(bool on);

    Archive &archive_;
    Recorder &recorder_;
    Downloads downloads_;
    std::unique_ptr<Errands> errands_;
    std::unique_ptr<Errands> long_errands_;
};

} // namespace console

#endif
