package skein.measure

/** A live flight and its virtual twins: flights in virtual time that are equal in everything but seed and
  * simulator.
  *
  * @param virtual the twins, at least one; their samples are combined
  */
final case class Twin(live: FlightSummary, virtual: Vector[FlightSummary]):

  /** The compared quantities that both flights have. */
  def compared: Vector[Compared] =
    for
      role     <- live.roles
      quantity <- Twin.quantities
      ours     <- quantity.of(role)
      theirs   <- Distribution.of(
        virtual.flatMap(_.roles).filter(_.role == role.role).flatMap(quantity.of(_)).flatMap(_.sorted)
      )
    yield Compared(role.role, quantity.title, ours, theirs)

  def find(role: String, quantity: String): Option[Compared] =
    compared.find(one => one.role == role && one.quantity == quantity)

  /** The headline measure (see [[FlightSummary.headline]]) of the live flight, and the twins' mean. */
  def converged: Option[(Double, Double)] =
    for
      ours   <- live.headline
      theirs <- Distribution.of(virtual.flatMap(_.headline))
    yield (ours, theirs.mean)

  /** Deviation of the live flight's headline measure, as a fraction of the size of the twins' measure; None
    * if that is 0.
    */
  def difference: Option[Double] = converged.collect:
    case (ours, theirs) if theirs != 0 => (ours - theirs) / theirs.abs

  def seeds: String =
    virtual.map(_.flight.seed).distinct.sorted match
      case Vector(seed) => s"seed $seed"
      case several      => s"${several.size} seeds, ${several.head} … ${several.last}"

  /** The simulators, if the twins have another than the live flight; else empty. */
  def unlike: String =
    val theirs = virtual.map(_.simulator).distinct
    if theirs == Vector(live.simulator) then ""
    else s"simulator ${live.simulator} live, ${theirs.mkString(", ")} virtual"

/** A quantity compared between a live flight and its twins, ms. */
final case class Compared(role: String, quantity: String, live: Distribution, virtual: Distribution):
  val distance: Double = KolmogorovSmirnov.distance(live, virtual, Compared.WithinMs)

object Compared:
  /** Tolerance within which times count as equal, ms: a live loop's timers are not more exact. */
  val WithinMs: Int = 1

object Twin:
  val Age: String       = "age of own data"
  val SinceMove: String = "time since own last move"

  private[skein] final case class Quantity(title: String, of: RoleSummary => Option[Distribution])

  private[skein] val quantities: Vector[Quantity] = Vector(
    Quantity(Age, _.ownTrueAgeMs),
    Quantity(SinceMove, _.observedMs.get(TimingObservation.SinceOwnMove))
  )

  /** Roles and quantities, in the order of tables, with a short name of each. */
  def columns(twins: Vector[Twin]): Vector[(String, String, String)] =
    for
      (quantity, short) <- Vector(Age -> "age", SinceMove -> "move")
      role              <- twins.flatMap(_.live.roles).map(_.role).distinct.sorted
    yield (role, quantity, s"KS $short ${role.head}.")

  /** Pairs every live flight with its virtual twins, if there are any. */
  def among(flights: Vector[FlightSummary]): Vector[Twin] =
    val virtual = flights.filter(isVirtual).groupBy(key)
    flights.filterNot(isVirtual).flatMap(live => virtual.get(key(live)).map(Twin(live, _)))

  private def isVirtual(summary: FlightSummary) = summary.flight.isVirtual

  private def key(one: FlightSummary) =
    import one.flight.{duration, link, period, scenario}
    (
      one.flownAs,
      link,
      period,
      duration,
      scenario,
      one.scenario,
      one.predictor,
      one.movesInFlight,
      one.options
    )
