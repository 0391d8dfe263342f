import sbt.*
import sbt.Keys.*

/** Options of the JVM that runs Skein. */
object Jvm {
  private val vector = Seq("--add-modules", "jdk.incubator.vector")

  /** For DuckDB's library, and for libraries that still use `sun.misc.Unsafe`. */
  val nativeAccess: Seq[String] = Seq("--enable-native-access=ALL-UNNAMED", "--sun-misc-unsafe-memory-access=allow")

  val options: Seq[String] = vector ++ nativeAccess

  /** For control: memory for the allocations of minutes of flight, so that no collection delays a decision; and
    * the collector with the shortest collections of that much (with planning 0.9 ms, G1's 1.5 to 5 ms).
    * Surviving objects are copied twice, not up to 15 times: 2 to 3 ms in place of 9 in `serve --hil`.
    */
  val control: Seq[String] =
    Seq("-XX:+UseParallelGC", "-Xms384m", "-Xmn256m", "-XX:MaxTenuringThreshold=1", "-XX:MetaspaceSize=128m")

  /** A garbage collector without threads of its own. */
  val oneCollector: Seq[String] = Seq("-XX:+UseSerialGC")

  /** For tests, most of which end before optimising compilation pays: a third to a half less of the
    * processor's time. Then there is little memory for compiled code, and full collections when it fills.
    */
  val brief: Seq[String] =
    oneCollector ++ Seq("-XX:TieredStopAtLevel=1", "-XX:ReservedCodeCacheSize=256m", "-XX:MetaspaceSize=128m")

  /** For the module whose Java sources use the vector API. */
  val vectorModule: Seq[Setting[?]] = Seq(Compile / javacOptions ++= vector)
}
