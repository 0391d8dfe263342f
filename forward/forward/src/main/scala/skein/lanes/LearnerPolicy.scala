package skein.lanes

import skein.policy.{Action, LearnerSpace, Observation, Policy}

/** Acts as its memory says, which a caller sets before each decision. Its next memory contains its
  * observation. So a learner's vehicle decides and observes by the code that other policies use.
  *
  * Its memory begins with the action: the turn and, if it climbs, the vertical speed, m/s. The components of
  * the observation follow.
  *
  * @param byRate whether the turn is a rate, rad/s; otherwise it is an angle, rad
  */
final case class LearnerPolicy(byRate: Boolean, space: LearnerSpace = LearnerSpace.Level) extends Policy:
  type Memory = Vector[Double]

  def start: Memory = Vector.fill(space.outputs + space.inputs)(0.0)

  override def isAgainstOne: Boolean = true

  override def isPlanar: Boolean = !space.climbs

  def choose(seen: Observation, memory: Memory): (Action, Memory) =
    val observed = space.observe(seen)
    val count    = space.outputs
    val turnRad  = if byRate then memory(0) * seen.elapsed.toSeconds else memory(0)
    (
      space.action(seen, turnRad, if space.climbs then memory(1) else 0),
      Vector.tabulate(memory.size)(i => if i < count then memory(i) else observed(i - count))
    )
