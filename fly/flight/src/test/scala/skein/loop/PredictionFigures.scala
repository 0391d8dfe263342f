package skein.loop

import skein.signal.LatencyProfile
import skein.vehicle.*

/** Prints the deviation of loops and models from the paused flight over the links.
  *
  * @param seeds number of flights per row
  * @param over the links' names; all by default
  */
@main def predictionFigures(seeds: Int, over: String*): Unit =
  val truth = VirtualDuel.truth.distanceM
  println(f"paused truth $truth%.3f m; $seeds seeds a row")
  val many  = LoopSettings(movesInFlight = 6)
  val links = Seq(
    ("direct", LatencyProfile.direct, LoopSettings()),
    ("vpn", LatencyProfile.vpn, LoopSettings()),
    ("vpn-mixed", LatencyProfile.vpnMixed, LoopSettings()),
    ("constant:400ms", VirtualDuel.constant(400), LoopSettings()),
    ("constant:400ms, 6 moves in flight", VirtualDuel.constant(400), many),
    ("vpn, 6 moves in flight", LatencyProfile.vpn, many)
  )
  for (name, link, settings) <- links if over.isEmpty || over.contains(name) do
    println(name)
    report("stream", LoopKind.Stream, link, settings)
    report("predictive", LoopKind.Predictive, link, settings)
    for (description, model) <- models do
      report(s"predictive, $description", LoopKind.Predictive, link, settings.copy(model = _ => model))

  def models: Seq[(String, VehicleModel[?])] =
    val identified          = ReducedModel.AirSim
    def lag(factor: Double) =
      identified.copy(lagS = factor * identified.lagS, turnLagS = factor * identified.turnLagS)
    def gain(factor: Double) = identified.copy(gain = factor * identified.gain)
    Seq(
      "reduced"             -> PlantModel(identified),
      "reduced, lag +20 %"  -> PlantModel(lag(1.2)),
      "reduced, lag -20 %"  -> PlantModel(lag(0.8)),
      "reduced, gain +20 %" -> PlantModel(gain(1.2)),
      "reduced, gain -20 %" -> PlantModel(gain(0.8)),
      "constant velocity"   -> ConstantVelocity,
      "constant turn"       -> ConstantTurn
    )

  def report(name: String, kind: LoopKind, link: LatencyProfile, settings: LoopSettings): Unit =
    val duels     = (1 to seeds).map(seed => VirtualDuel.fly(kind, link, seed, settings))
    val distances = duels.map(_.distanceM)
    val mean      = distances.sum / seeds
    val spread    = math.sqrt(distances.map(d => (d - mean) * (d - mean)).sum / (seeds - 1).max(1))
    val ages      = duels.flatMap(_.recording.predictions.map(_.age.toMillis))
    val errors    = duels.flatMap(_.predictionErrors(own = true)).sorted
    val predicted =
      if errors.isEmpty then ""
      else
        f"; prediction age ${ages.sum / ages.size}%.0f ms, own error p50 " +
          f"${errors(errors.size / 2)}%.4f p95 ${errors(errors.size * 95 / 100)}%.4f m"
    println(
      f"  $name%-30s $mean%.3f ± $spread%.3f m (${(mean / truth - 1) * 100}%+.2f " +
        f"%%, ${distances.min}%.2f to ${distances.max}%.2f)$predicted"
    )
