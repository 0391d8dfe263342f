import sbt.*
import sbt.Keys.*

/** What the JVM is told where Skein runs. */
object Jvm {
  private val vector = Seq("--add-modules", "jdk.incubator.vector")

  /** For DuckDB's library, and for libraries that still use `sun.misc.Unsafe`. */
  val nativeAccess: Seq[String] = Seq("--enable-native-access=ALL-UNNAMED", "--sun-misc-unsafe-memory-access=allow")

  val options: Seq[String] = vector ++ nativeAccess

  /** For control: room for what minutes of flight allocate, so that no collection falls into a decision; and
    * the collector whose collections of so much are the shortest (with plans made meanwhile 0.9 ms, G1's 1.5
    * to 5 ms). What lives on is copied twice, not up to 15 times: 2 to 3 ms in the place of 9 in
    * `serve --hil`.
    */
  val control: Seq[String] =
    Seq("-XX:+UseParallelGC", "-Xms384m", "-Xmn256m", "-XX:MaxTenuringThreshold=1", "-XX:MetaspaceSize=128m")

  /** Collecting costs no threads of its own. */
  val oneCollector: Seq[String] = Seq("-XX:+UseSerialGC")

  /** For tests, most of which have ended before optimising them pays: a third to a half less of the
    * processor's time.
    */
  val brief: Seq[String] = oneCollector :+ "-XX:TieredStopAtLevel=1"

  /** For the module whose Java sources use the vector API. */
  val vectorModule: Seq[Setting[?]] = Seq(Compile / javacOptions ++= vector)
}
