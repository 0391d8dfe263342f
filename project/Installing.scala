import java.nio.file.Files
import sbt.*
import sbt.Keys.*
import sbt.plugins.IvyPlugin

/** `./sbtw installLocal`: installs every part on this machine, for users' projects.
  *
  * Parts are published into a folder beside the local repository, and moved into it when all of them are
  * complete. So an installation that fails, or is interrupted, leaves the previous one.
  */
object Installing extends AutoPlugin {

  override def requires: Plugins      = IvyPlugin
  override def trigger: PluginTrigger = allRequirements

  object autoImport {
    val installLocal = taskKey[Unit]("puts every part into this machine's local repository, all of them or none")
  }
  import autoImport.*

  private val installedBeside = taskKey[Unit]("publishes a part beside the local repository")

  private val ivyHome = Def.setting(ivyPaths.value.ivyHome.getOrElse(sys.error("expected a home of Ivy, got none")))
  private val beside  = Def.setting(ivyHome.value / "local-installing")

  /** Settings of the root project. */
  val settings: Seq[Setting[?]] = Seq(
    installLocal / aggregate := false,
    installLocal             := Def.sequential(
      Def.task(IO.delete(beside.value)),
      installedBeside.all(ScopeFilter(inAnyProject)),
      Def.task {
        val published = beside.value
        val local     = ivyHome.value / "local"
        val replaced  = published / "replaced"
        for (part <- (published * "*" * "*" * "*").get if !part.getPath.startsWith(replaced.getPath)) {
          val path      = IO.relativize(published, part).get
          val installed = local / path
          IO.createDirectories(Seq(installed.getParentFile, (replaced / path).getParentFile))
          if (installed.exists) Files.move(installed.toPath, (replaced / path).toPath)
          Files.move(part.toPath, installed.toPath)
        }
        IO.delete(published)
      }
    ).value
  )

  override val projectSettings: Seq[Setting[?]] = Seq(
    otherResolvers += Resolver.file("beside", beside.value)(Resolver.ivyStylePatterns),
    installedBeside := Def.taskDyn {
      if ((publish / skip).value) Def.task(())
      else
        Def.task {
          val configuration = publishLocalConfiguration.value.withResolverName("beside")
          publisher.value.publish(ivyModule.value, configuration, streams.value.log)
        }
    }.value
  )
}
