package skein.lanes

import skein.forward.*
import skein.identify.Tilting
import skein.policy.*
import skein.signal.LatencyProfile
import skein.simd.WorldRandom
import skein.vehicle.{ReducedModel, SensorNoise}

/** Measures the speed of each loop with SIMD, compared with the scalar engine: `forward/Test/runMain
  * skein.lanes.timingRates [text] [-text]`: on one thread, 60 s over `vpn` by default; only cases that
  * contain a text, or that do not contain a text after a minus sign; processor time. Agent-steps of a period,
  * in millions a second.
  */
@main def timingRates(only: String*): Unit =
  val times  = java.lang.management.ManagementFactory.getThreadMXBean
  val models = Seq[(String, VelocityResponse)](
    "lag"       -> PlantResponse(ReducedModel.AirSimLag),
    "drag"      -> PlantResponse(ReducedModel.AirSim),
    "quadrotor" -> VelocityResponses.quadrotor(),
    "bicycle"   -> PlantResponse(Bicycle(1.2, 0.3, 4, 0.4)),
    "skating"   -> PlantResponse(Skating(0.4, 1.5)),
    "tilting"   -> PlantResponse(Tilting(0.95, 0.9, 0.2))
  )
  val eye     = GuideCamera.model
  val sensors = Seq("", "position=0.3,velocity=0.1", "position=0.3,drift=1.5/60s,dropout=5%,outage=1s/20s")
  for
    shared        <- Seq(true, false)
    (name, model) <- models
    timing        <- Seq(
      LoopTiming.Stream(),
      LoopTiming.Sequential(),
      LoopTiming.Futures(),
      LoopTiming.Predictive(predictor = model.predictor)
    )
    sees <- if name == "lag" then Seq(false, true) else Seq(false)
    losing = Seq("loss:5%", "loss:5%/4", "outage:1s/10s").map: text =>
      val link = LatencyProfile.parse(s"$text,vpn", Left(_)).toOption.get
      s" over $text" -> LinkDelays.checked(link, timing, vehicles = 2).toOption.get
    mixed = if !shared && name == "lag" then (" over vpn-mixed" -> LinkDelays.vpnMixed) +: losing else Nil
    (linked, over) <- Seq[(String, Delays)]("" -> DelayTable.vpn) ++ mixed
    text           <- if sees || linked.nonEmpty then Seq("") else sensors
    row = s"${if shared then "shared" else "own"} $name ${timing.productPrefix.toLowerCase}${
        if sees then " by eye" else ""
      }$linked${if text.isEmpty then "" else s" with $text"}"
    if only.forall(text => if text.startsWith("-") then !row.contains(text.drop(1)) else row.contains(text))
  do
    val flown = if text.isEmpty then model else SensedResponse(model, SensorNoise.parse(text).toOption.get)
    val duel  = Pair.paper.copy(pursuer = Pair.paper.pursuer.copy(eye = Option.when(sees)(eye)))
    val batch = PairBatch(duel, timing, flown, threads = 1)
    def worlds(count: Int, from: Int): PairWorlds = new PairWorlds:
      def size: Int                       = count
      override def shareEpisodes: Boolean = shared
      def key(world: Int): Int            =
        WorldRandom.key(3, 1, if shared then from + world / 512 % 8 else from + world)
      def link(world: Int): Delays    = over
      def pursuer(world: Int): Policy = PaperPursuer(0.6 + 1e-4 * (world % 512))
      def evader(world: Int): Policy  = PaperEvader()
    val isFast = batch.engine(PaperPursuer(), PaperEvader(), shared, Seq(over)).isFast

    /** Processor time of the batch's own threads, which end with each call. */
    def rate(count: Int): Double =
      val os = java.lang.management.ManagementFactory.getOperatingSystemMXBean.asInstanceOf[
        com.sun.management.OperatingSystemMXBean
      ]
      val from = os.getProcessCpuTime
      batch.fly(worlds(count, 0)): Unit
      count * 1200.0 / ((os.getProcessCpuTime - from) * 1e-3)
    val slow  = !isFast || name == "quadrotor"
    val count = if slow then 64
    else if sees || !name.endsWith("lag") && name != "drag" then 8192
    else if shared then 163840
    else 40960
    val warm = System.nanoTime() + 4_000_000_000L
    while System.nanoTime() < warm do rate(count): Unit
    val lanes                        = Vector.fill(9)(rate(count)).max
    val rollout                      = Rollout(duel.engagement, timing, over, flown)
    def scalar(flights: Int): Double =
      val from = times.getCurrentThreadCpuTime
      for flight <- 1 to flights do rollout.fly(flight): Unit
      flights * 1200.0 / ((times.getCurrentThreadCpuTime - from) * 1e-3)
    scalar(60): Unit
    val reference = Vector.fill(3)(scalar(30)).max
    println(
      f"$row%-42s ${if isFast then "SIMD  " else "scalar"} $lanes%7.2f M/s  " +
        f"scalar $reference%.3f M/s  ${lanes / reference}%6.1f times"
    )
