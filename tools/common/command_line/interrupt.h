/* Ctrl-C and SIGTERM as a question: programs that run until somebody ends them ask it in their loop.
 *
 *   cli::catch_interrupts();
 *   while (!cli::interrupted()) ... */
#ifndef ALE_COMMON_COMMAND_LINE_INTERRUPT_H
#define ALE_COMMON_COMMAND_LINE_INTERRUPT_H

namespace cli
{

/* From now on the two signals no longer end the program, and a wait in the kernel ends at once when one comes
 * (EINTR). */
void catch_interrupts();

/* Whether one has come. Any thread. */
bool interrupted();

} // namespace cli

#endif
