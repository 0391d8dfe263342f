package skein.vtime;

import org.apache.pekko.actor.ActorSystem;
import org.apache.pekko.actor.ActorSystemImpl;

/** Lists live actors for reports. In Java, because Scala cannot access Pekko's private classes. */
final class ActorTree {
  private ActorTree() {}

  static String of(ActorSystem system) {
    return system instanceof ActorSystemImpl impl ? impl.printTree() : system.toString();
  }
}
