package skein.vtime.agent;

import java.lang.instrument.Instrumentation;
import java.util.ArrayList;
import java.util.List;

/**
 * Started by {@code -javaagent:vtime-agent.jar[=package,package…]}: rewrites classes of Pekko, of
 * {@code scala.concurrent} and of the named packages as they are loaded.
 */
public final class Agent {
  private static volatile String failure;

  private Agent() {}

  public static void premain(String packages, Instrumentation instrumentation) {
    var prefixes = new ArrayList<>(Rewriter.PACKAGES);
    if (packages != null)
      for (var name : packages.split(",")) if (!name.isBlank()) prefixes.add(name.strip().replace('.', '/') + "/");
    Rewriter.defineDraws();
    instrumentation.addTransformer(new Rewriter(List.copyOf(prefixes), Agent::failed));
  }

  /** Returns the first class that could not be rewritten and why, or null. */
  public static String failure() {
    return failure;
  }

  private static void failed(String className, Throwable cause) {
    if (failure == null) failure = className + ": " + cause;
  }
}
