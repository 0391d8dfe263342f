package skein.cli

import org.apache.pekko.actor.ActorSystem
import skein.link.TimeSlice

/** The actor system of a command that acts by the clock: its threads take the processor soon after they wake. */
private[cli] object LiveSystem:
  def apply(name: String): ActorSystem =
    val _ = TimeSlice.shorten()
    ActorSystem(name)
