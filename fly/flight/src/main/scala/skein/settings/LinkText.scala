package skein.settings

import skein.forward.{Delays, LinkDelays, LoopTiming}
import skein.signal.LatencyProfile

/** Links as users state them; the trace of `file:PATH` is read from its file. */
object LinkText:
  def profile(text: String): Either[String, LatencyProfile] =
    LatencyProfile.parse(text, TextFile.read).left.map(_.message)

  /** The delays of a link between a controller and its vehicles in forward simulation. */
  def delays(text: String, timing: LoopTiming, vehicles: Int): Either[String, Delays] =
    profile(text).flatMap(LinkDelays.checked(_, timing, vehicles))
