import sbt.*
import sbt.Keys.*
import sbt.plugins.JvmPlugin

/** A built checkout that was copied or moved. sbt's caches name files by whole paths: the packager would take
  * the original's stage for what it made here itself, and empty it. So if the checkout's path differs from that of
  * its last build, the caches are deleted; compiled classes stay, since the compiler's analysis has no such paths.
  */
object Copied extends AutoPlugin {
  override def trigger  = allRequirements
  override def requires = JvmPlugin

  override def globalSettings: Seq[Setting[?]] =
    Seq(onLoad := onLoad.value.andThen { state => forget(state); state })

  private def forget(state: State): Unit = {
    val loaded = Project.extract(state)
    val home   = loaded.get(ThisBuild / baseDirectory).getCanonicalPath
    val note   = file(home) / "target" / "built-at.txt"
    if (!note.exists || IO.read(note) != home) {
      IO.delete(loaded.structure.allProjectRefs.map(project => loaded.get(project / target) / "streams"))
      IO.write(note, home)
    }
  }
}
