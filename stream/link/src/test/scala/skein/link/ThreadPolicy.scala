package skein.link

import java.nio.file.{Files, Path}

/** How Linux schedules a thread, read from /proc. */
private object ThreadPolicy:

  /** A thread's policy number, from its folder in /proc: the 41st field of proc_pid_stat(5). The second field
    * may contain spaces, but ends with the last parenthesis.
    */
  def of(thread: Path): Int =
    val stat = Files.readString(thread.resolve("stat"))
    stat.substring(stat.lastIndexOf(')') + 2).split(' ')(41 - 3).toInt
