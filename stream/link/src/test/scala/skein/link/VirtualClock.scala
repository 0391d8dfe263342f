package skein.link

import org.apache.pekko.actor.ActorSystem
import skein.units.Clock
import skein.vtime.VirtualTime

object VirtualClock:

  def apply(system: ActorSystem): Clock = Clock.ofNanos(VirtualTime.clock(system))
