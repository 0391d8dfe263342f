package skein.link

import org.apache.pekko.actor.ActorSystem
import skein.units.Clock
import skein.vtime.VirtualTime

object VirtualClock:

  /** The clock of a system in virtual time. */
  def apply(system: ActorSystem): Clock = Clock.ofNanos(VirtualTime.clock(system))
