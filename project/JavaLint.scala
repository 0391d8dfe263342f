import sbt.*
import sbt.Keys.*
import sbt.plugins.JvmPlugin

/** Every warning of javac is an error. Except that the vector module is incubating, which the JVM states at
  * every start.
  */
object JavaLint extends AutoPlugin {
  override def requires: Plugins      = JvmPlugin
  override def trigger: PluginTrigger = allRequirements

  private val lint = Seq("-Xlint:all,-incubating", "-Werror")

  override val projectSettings: Seq[Setting[?]] =
    Seq(Compile / compile / javacOptions ++= lint, Test / compile / javacOptions ++= lint)
}
