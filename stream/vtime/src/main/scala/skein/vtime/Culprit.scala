package skein.vtime

/** Shows where the thread stood that a run ended by. */
private final class Culprit extends RuntimeException(s"on thread '${Thread.currentThread.getName}'")
