package skein.loop

import org.apache.pekko.stream.Attributes
import skein.policy.Fleet

/** The parts of a team's graph: their names, and what passes them. */
private final class TeamParts(fleet: Fleet):

  /** What passes the parts of the loop's graph. */
  val meters: StageMeters = StageMeters()

  /** Names a part of the graph. */
  def named(part: String): Attributes = Attributes(meter(part))

  /** Names the part of one vehicle. */
  def named(part: String, vehicle: Int): Attributes = Attributes(meter(part, vehicle))

  def meter(part: String): StageMeter = meters(part)

  def meter(part: String, vehicle: Int): StageMeter = meters(s"$part(${fleet.agents(vehicle).name})")
