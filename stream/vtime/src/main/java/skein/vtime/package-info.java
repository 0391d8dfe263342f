/**
 * Any Pekko graph in virtual time: deterministic, and as fast as the processor allows.
 *
 * <p>{@code VirtualTime.run(seed)(system => future)} starts an actor system whose scheduler, dispatchers and
 * clock readings live on one run-to-completion loop on the calling thread. Tasks run first in, first out;
 * when none is left, time jumps to the earliest timer, and of equal times the timer set first fires first. So
 * equal seeds and equal code give equal runs, in any JVM, alone or concurrently with runs on other threads.
 *
 * <p>Readings of the clock and random draws inside of Pekko and {@code scala.concurrent} are redirected by
 * the agent ({@code skein.vtime.agent}), with which the JVM must be started. On threads without a loop they
 * are unchanged. Anything that would make a run wrong (another thread's interference, blocking, sockets) ends
 * it and names the culprit: see {@code Problem}. The README of this module explains the set-up and what the
 * agent cannot redirect.
 */
package skein.vtime;
