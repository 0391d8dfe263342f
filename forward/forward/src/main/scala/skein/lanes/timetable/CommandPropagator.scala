package skein.lanes.timetable

import skein.units.Span

/** Computes when each command takes effect, as [[PlantModel]] does: a dead time after its arrival. Unlike
  * there, a command that equals its predecessor counts as a new one; with drag this adds a piece.
  *
  * @param propagation creates the result from the pieces and the end of the last, s from the reading
  */
private[lanes] final class CommandPropagator private (
    deadTime: Span,
    propagation: (Vector[CommandPropagator.Flown], Double) => Propagation,
    held: CommandPropagator.Known
) extends Propagator:
  import CommandPropagator.*

  def next(legs: Vector[Propagator.Leg]): Propagator =
    new CommandPropagator(deadTime, propagation, legs.foldLeft(held)(_.through(_, deadTime)._2))

  def predicted(legs: Vector[Propagator.Leg]): Propagation =
    val flown  = Vector.newBuilder[Flown]
    var known  = held
    var startS = 0.0
    for leg <- legs do
      val (due, after)        = known.through(leg, deadTime)
      val endS                = startS + leg.span.toSeconds
      var acting              = known.acting
      var fromS               = startS
      def fly(untilS: Double) = if untilS > fromS then flown += Flown(acting, fromS, untilS)
      for (decision, in) <- due do
        val actsS = startS + in.toSeconds
        fly(actsS)
        acting = decision
        fromS = actsS
      fly(endS)
      known = after
      startS = endS
    propagation(flown.result(), startS)

private[lanes] object CommandPropagator:
  def apply(deadTimeS: Double, propagation: (Vector[Flown], Double) => Propagation): Propagator =
    new CommandPropagator(Span.ofSeconds(deadTimeS), propagation, Known(0, 0, Vector.empty))

  /** A piece of a prediction under the command of one decision; times are s from the reading. */
  final case class Flown(decision: Int, fromS: Double, untilS: Double)

  /** Creates a propagation from pieces, with `perPart` values for each.
    *
    * @param tell writes the values of a piece into an array, from an index on
    */
  def told(flown: Vector[Flown], perPart: Int, first: Double = 0, second: Double = 0)(
      tell: (Flown, Array[Float], Int) => Unit
  ): Propagation =
    val numbers = Array.ofDim[Float](flown.size * perPart)
    for (part, i) <- flown.zipWithIndex do tell(part, numbers, i * perPart)
    Propagation(flown.map(_.decision).toArray, numbers, first.toFloat, second.toFloat)

  /** The commands of [[PlantModel.Flying]], identified by their decisions.
    *
    * @param coming pending commands, with the time until each takes effect
    */
  final case class Known(acting: Int, last: Int, coming: Vector[(Int, Span)]):
    /** Finds the commands that take effect within a leg, in the order of their arrival, with the time until
      * each does. Also returns the commands at the end of the leg.
      */
    def through(leg: Propagator.Leg, deadTime: Span): (Vector[(Int, Span)], Known) =
      val now            = if leg.decision == last then coming else coming :+ (leg.decision, deadTime)
      val (due, waiting) = now.span(_._2 <= leg.span)
      val behind         = waiting.map((decision, in) => (decision, in - leg.span))
      (due, Known(due.lastOption.fold(acting)(_._1), leg.decision, behind))
