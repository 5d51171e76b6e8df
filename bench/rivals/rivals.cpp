
#include <cstdio>
#include <cstdlib>
#include <string>
#include <sstream>
#include <iostream>
#include <chrono>
#include "stage.hpp"
using namespace burin; using namespace burin::rivals;
static double now(){return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();}
int main(int argc,char**argv){
  std::string scene=argv[1], viewname=argv[2]; int finest=atoi(argv[3]);
  auto context=gl::open_context(Backend::osmesa);
  const auto*e=scenes::find_scene(scene);
  auto subject=bench::prepare_subject(*e);
  double t=now();
  SceneMaps maps(**context,*subject,finest,"/tmp/cache/rivals");
  std::printf("maps %.1fs channels %zu drops %g %g depth %g size %g\n",now()-t,maps.surface().channels(),maps.surface().highest,maps.surface().lowest,subject->prepared.resolved.depth,subject->prepared.resolved.size.x);
  std::vector<std::string> lines; for(std::string l;std::getline(std::cin,l);) lines.push_back(l);
  for(auto&view:bench::standard_views(*subject,96,72)){
    if(viewname!="all"&&view.name!=viewname)continue;
    Stage stage(**context,*subject,maps,view,"/tmp/cache");
    auto show=[&](const char*label,const Draw&d){auto r=stage.measure(d,5);std::printf("%s %s: %.1f dB %.2f ms\n",view.name.c_str(),label,r.decibels,r.milliseconds);
      (void)!write_png("/tmp/r_pics/"+view.name+"_"+label+".png",bench::show_difference(d().image(),stage.truth()));fflush(stdout);};
    show("burin",*stage.burin([](RenderOptions&){}));
    for(auto&l:lines){ // tech size samples steps refinements bias aniso wide hammersley edge slack passes
      std::istringstream in(l); int tech,wide,ham,passes; double edge; RivalSettings s; in>>tech>>s.size>>s.samples>>s.steps>>s.refinements>>s.bias>>s.anisotropy>>wide>>ham>>edge>>s.shadow_slack>>passes;
      s.technique=Technique(tech);s.wide_heights=wide;s.places=ham?Places::hammersley:Places::grid;s.edge=edge*stage.pixel_in_uv();s.passes=passes;
      double t0=now();
      auto d=stage.rival(s); if(!d){std::printf("%s\n",d.error().message.c_str());continue;}
      (*d)();
      double t1=now()-t0; if(t1>2)std::printf("(load %.1fs)\n",t1);
      show(l.c_str(),*d);
    }
  }
}
