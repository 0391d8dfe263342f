package skein.planning

import skein.simd.WorldRandom

/** Several possible behaviours of a target, against which every candidate is simulated. */
object Behaviours:

  /** The estimated target, with half of the weight, and variations of it, drawn from a stream: displaced by
    * about 0.2 m, with a policy that an observer may assume ([[skein.policy.Policy.guessed]]). A stream gives
    * equal behaviours each time, so that all candidates of a tick are compared fairly.
    */
  def around(target: Target, count: Int, stream: Long): Vector[Behaviour] =
    require(count > 0, s"at least one behaviour is needed, got $count")
    def draw(of: Int, variant: Int)(place: Int): Double =
      Draws.normal(WorldRandom.key(stream, of, variant), place).toDouble
    def off(variant: Int, place: Int) = draw(0, variant)(place) * PlaceSd
    def variant(number: Int): Target  = target match
      case opponent: Target.Opponent =>
        opponent.copy(
          vehicle = opponent.vehicle.moved(off(number, 0), off(number, 1)),
          policy = opponent.policy.guessed(draw(1, number))
        )
      case along: Target.Along =>
        val (x, y) = (off(number, 0), off(number, 1))
        val track  = along.track
        along.copy(track =
          PredictedTrack(
            IArray.tabulate(track.steps)(track.x(_) + x),
            IArray.tabulate(track.steps)(track.y(_) + y)
          )
        )
    if count == 1 then Vector(Behaviour(target))
    else
      Behaviour(target, 0.5) +:
        Vector.tabulate(count - 1)(number => Behaviour(variant(number), 0.5 / (count - 1)))

  private val PlaceSd = 0.2
