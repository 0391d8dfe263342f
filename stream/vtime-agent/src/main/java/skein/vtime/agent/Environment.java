package skein.vtime.agent;

import java.util.random.RandomGenerator;

/**
 * What rewritten code on a thread asks instead of the JVM: time, randomness, and leave to block or to go
 * elsewhere.
 */
public interface Environment {

  /** Nanoseconds since the Unix epoch; the answer to {@code nanoTime} too. */
  long nanoTime();

  /**
   * Source of every draw that would have come from {@code ThreadLocalRandom}, {@code Math} or {@code UUID}.
   */
  RandomGenerator random();

  /** The next name of an actor that supervises streams. */
  String supervisorName();

  /** Called in place of a call that would block the thread, such as {@code Thread.sleep}; must throw. */
  RuntimeException blocked(String call);

  /**
   * Called before a task is handed to a {@code scala.concurrent.ExecutionContext}; throws where that is an
   * escape.
   */
  void submitted(Object executionContext);
}
