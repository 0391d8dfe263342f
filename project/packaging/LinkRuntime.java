import java.lang.classfile.ClassFile;
import java.lang.classfile.ClassTransform;
import java.lang.classfile.attribute.ModuleResolutionAttribute;
import java.util.EnumSet;
import java.util.Set;
import java.util.spi.ToolProvider;
import jdk.tools.jlink.internal.PluginRepository;
import jdk.tools.jlink.plugin.Plugin;
import jdk.tools.jlink.plugin.ResourcePool;
import jdk.tools.jlink.plugin.ResourcePoolBuilder;

/**
 * jlink, whose image takes jdk.incubator.vector for a module like any other: it is resolved without being asked
 * for, is not remarked on at each start, and does not keep the JVM from using its ahead-of-time cache.
 */
final class LinkRuntime implements Plugin {
  public static void main(String... words) {
    PluginRepository.registerPlugin(new LinkRuntime());
    System.exit(ToolProvider.findFirst("jlink").orElseThrow().run(System.out, System.err, words));
  }

  @Override
  public String getName() {
    return "settled-vectors";
  }

  @Override
  public Category getType() {
    return Category.FILTER;
  }

  @Override
  public Set<State> getState() {
    return EnumSet.of(State.AUTO_ENABLED, State.FUNCTIONAL);
  }

  @Override
  public ResourcePool transform(ResourcePool in, ResourcePoolBuilder out) {
    in.transformAndCopy(
        entry -> {
          if (!entry.path().equals("/jdk.incubator.vector/module-info.class")) return entry;
          var file = ClassFile.of();
          var settled =
              file.transformClass(
                  file.parse(entry.contentBytes()),
                  ClassTransform.dropping(element -> element instanceof ModuleResolutionAttribute));
          return entry.copyWithContent(settled);
        },
        out);
    return out.build();
  }
}
