package skein.vtime

/** Carries the stack of the thread whose action ended a run. */
private final class Culprit extends RuntimeException(s"on thread '${Thread.currentThread.getName}'")
