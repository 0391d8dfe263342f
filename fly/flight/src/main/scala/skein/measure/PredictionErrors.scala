package skein.measure

import skein.record.Recording

/** Errors of predictions of one kind of vehicle, by their age.
  *
  * @param made number of predictions; those without a sample concern a moment that was never read, or read
  *   with too wide a gap around it
  * @param samples the verified predictions: age, from the reading to the predicted moment, ms, and error, m
  */
final case class PredictionErrors(made: Int, samples: Vector[(Double, Double)]):
  def unverified: Int = made - samples.size

  def ++(other: PredictionErrors): PredictionErrors =
    PredictionErrors(made + other.made, samples ++ other.samples)

  def errors: Option[Distribution] = Distribution.of(samples.map(_._2))

  /** Errors of predictions whose age rounds to `ageMs`, to the nearest multiple of
    * [[PredictionErrors.BinMs]]; absent if they are fewer than [[PredictionErrors.Fewest]].
    */
  def around(ageMs: Int): Option[Distribution] = byAge.collectFirst { case (`ageMs`, errors) => errors }

  /** Errors by age, ms, ascending; ages with fewer than [[PredictionErrors.Fewest]] samples are left out. */
  def byAge: Vector[(Int, Distribution)] =
    samples
      .groupMap((age, _) => PredictionErrors.bin(age))(_._2)
      .toVector
      .sortBy(_._1)
      .flatMap((age, errors) =>
        Distribution.of(errors).filter(_.count >= PredictionErrors.Fewest).map(age -> _)
      )

  /** [[byAge]] in stretches without gaps between the ages. */
  def stretches: Vector[Vector[(Int, Distribution)]] =
    byAge.foldLeft(Vector.empty[Vector[(Int, Distribution)]]): (found, next) =>
      found.lastOption match
        case Some(last) if next._1 - last.last._1 == PredictionErrors.BinMs => found.init :+ (last :+ next)
        case _                                                              => found :+ Vector(next)

object PredictionErrors:
  val BinMs: Int = 20

  /** Minimum number of samples for a 95 % quantile that a few outliers do not move: of 40, two lie above it.
    */
  val Fewest: Int = 40

  private def bin(ageMs: Double): Int = (ageMs / BinMs).round.toInt * BinMs

  /** Errors for the deciding vehicles themselves, and for other vehicles; absent if nothing was predicted.
    *
    * @param isDuel whether all play against one opponent each
    */
  def of(recording: Recording, isDuel: Boolean): Option[(own: PredictionErrors, others: PredictionErrors)] =
    val predicted = recording.decisions.filter(_.predicted.nonEmpty)
    val decisions = predicted.groupMapReduce(_.vehicle)(_ => 1)(_ + _)
    // A decider predicts once per decision each vehicle that it predicts at all: itself, and in a duel its
    // opponent, even if not one of these predictions could be verified.
    val opponents = if isDuel then predicted.map(one => (one.vehicle, one.opponent.vehicle)) else Vector.empty
    val pairs     = (predicted.map(one => (one.vehicle, one.vehicle)) ++
      opponents ++
      recording.predictions.map(one => (one.decider, one.vehicle))).distinct
    def errors(own: Boolean) =
      def isAsked(decider: String, vehicle: String) = (decider == vehicle) == own
      PredictionErrors(
        pairs.collect {
          case (decider, vehicle) if isAsked(decider, vehicle) => decisions.getOrElse(decider, 0)
        }.sum,
        recording.predictions.collect:
          case one if isAsked(one.decider, one.vehicle) => (one.age.toMillis, one.error.value)
      )
    Option.when(decisions.nonEmpty)((own = errors(own = true), others = errors(own = false)))
