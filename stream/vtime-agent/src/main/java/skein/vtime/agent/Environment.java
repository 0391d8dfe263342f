package skein.vtime.agent;

import java.util.random.RandomGenerator;

/**
 * Answers rewritten code on a thread in place of the JVM: time, randomness, and permission to block or to use
 * other threads.
 */
public interface Environment {

  /** Nanoseconds since the Unix epoch; the answer to {@code nanoTime} too. */
  long nanoTime();

  /**
   * Source of every draw that rewritten code makes from {@code ThreadLocalRandom}, {@code Math} or {@code
   * UUID}.
   */
  RandomGenerator random();

  /** The next name of an actor that supervises streams. */
  String supervisorName();

  /** Called in place of a call that would block the thread, such as {@code Thread.sleep}; must throw. */
  RuntimeException blocked(String call);

  /**
   * Called before a task is passed to a {@code scala.concurrent.ExecutionContext}; throws if the context's
   * own threads would run it outside virtual time.
   */
  void submitted(Object executionContext);
}
