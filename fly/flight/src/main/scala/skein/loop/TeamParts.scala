package skein.loop

import org.apache.pekko.stream.Attributes
import skein.policy.Fleet
import skein.units.Clock

/** What the parts of a team's graph share: above all, their names and meters. */
private final class TeamParts(
    val fleet: Fleet,
    val own: Vector[Int],
    val clock: Clock,
    val settings: LoopSettings,
    val log: TeamLog
):

  val meters: StageMeters = StageMeters()

  def named(part: String): Attributes = Attributes(meter(part))

  def named(part: String, vehicle: Int): Attributes = Attributes(meter(part, vehicle))

  def meter(part: String): StageMeter = meters(part)

  def meter(part: String, vehicle: Int): StageMeter = meters(s"$part(${fleet.agents(vehicle).name})")
