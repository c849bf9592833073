/* The word that lets somebody in: it is part of the address that the console prints.
 *
 * It lies in a file for its owner alone, so that an address stays good when the console is started again,
 * and so that no list of processes shows it. */
#ifndef CONSOLE_TOKEN_H
#define CONSOLE_TOKEN_H

#include <string>

namespace console
{

/* 12 to 128 letters and digits. */
bool is_token(const std::string &text);

/* 128 random bits in hex. */
std::string random_token();

/* The token in the file, which is made when it is not there: rights 0600, its folder 0700. Throws
 * std::runtime_error naming the file: not readable or writable (the system's words), no regular file, of
 * another owner, with rights for others, no token in it. */
std::string token_of_file(const std::string &path);

/* $XDG_STATE_HOME/ale-slam/console.token, or below ~/.local/state; empty where there is no home. */
std::string usual_token_file();

/* Overwrites the token in the words that a list of processes shows. */
void hide_in_arguments(const std::string &token, int argc, char **argv);

} // namespace console

#endif
