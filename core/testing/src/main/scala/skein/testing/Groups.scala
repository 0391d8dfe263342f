package skein.testing

// How a suite is run: `project/TestGroups.scala` reads it from the suite's class file.

/** Measures time, or changes how threads of its JVM are scheduled: nothing else runs meanwhile. */
trait Timing extends Unhurried

/** Mostly waits, for other programs or for the real clock: runs beside those that compute. */
trait Waiting extends Unhurried

/** Takes long: whole processes, foreign programs, minutes by the clock. Run by `testAll` alone, in a JVM of
  * its own, which it may change for good: before a live flight its compilers are told to give way, and on a
  * busy machine everything behind it would be interpreted.
  */
trait Lengthy extends Unhurried

/** Computes for so long that optimising it pays, or by vectors, which are slow until they are optimised. */
trait Optimised extends Unhurried
