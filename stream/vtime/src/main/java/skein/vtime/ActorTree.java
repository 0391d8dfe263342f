package skein.vtime;

import org.apache.pekko.actor.ActorSystem;
import org.apache.pekko.actor.ActorSystemImpl;

/** Shows who is alive, for reports. In Java, because Scala may not look into Pekko's systems. */
final class ActorTree {
  private ActorTree() {}

  static String of(ActorSystem system) {
    return system instanceof ActorSystemImpl impl ? impl.printTree() : system.toString();
  }
}
