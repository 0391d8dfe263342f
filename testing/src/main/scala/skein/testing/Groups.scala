package skein.testing

// How a suite is run: `project/TestGroups.scala` reads it from the suite's class file.

/** Measures time, or flies for minutes by the clock beside other programs: nothing else runs meanwhile. */
trait Timing

/** Mostly waits, for other programs or for the real clock: runs beside those that compute. */
trait Waiting

/** Has a JVM of its own: it takes long, and then runs beside others; or it tells the compilers of its JVM to give way, for
  * good, as is done before a live flight, and on a busy machine everything behind it would be interpreted.
  */
trait Alone

/** Computes for so long that optimising it pays, or by vectors, which are slow until they are optimised. */
trait Optimised
