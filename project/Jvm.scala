import sbt.*
import sbt.Keys.*

/** What the JVM is told where Skein runs. */
object Jvm {
  private val vector = Seq("--add-modules", "jdk.incubator.vector")

  /** For DuckDB's library, and for libraries that still use `sun.misc.Unsafe`. */
  val nativeAccess: Seq[String] = Seq("--enable-native-access=ALL-UNNAMED", "--sun-misc-unsafe-memory-access=allow")

  val options: Seq[String] = vector ++ nativeAccess

  /** For the module whose Java sources use the vector API. */
  val vectorModule: Seq[Setting[?]] = Seq(Compile / javacOptions ++= vector)
}
